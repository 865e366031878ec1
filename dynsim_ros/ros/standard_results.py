# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""How the standard services of simulation_interfaces answer: codes, and one line of words."""

OK = 'RESULT_OK'
UNSUPPORTED = 'RESULT_FEATURE_UNSUPPORTED'
NOT_FOUND = 'RESULT_NOT_FOUND'
FAILED = 'RESULT_OPERATION_FAILED'


class Refusal(Exception):
    """What is not done, in one line; code: name of a constant of the service's, or of Result."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def fill_in(response, code, text=''):
    """Let the result of a response have a code, by name, and a text."""
    result, own = response.result, getattr(type(response), code, None)
    # Codes of a service that its older versions lack are what Result says of all the rest.
    general = getattr(type(result), code, getattr(type(result), FAILED))
    result.result, result.error_message = general if own is None else own, text


def must_succeed(answer, code):
    """Raise a Refusal with a code if (success, text) is no success."""
    success, text = answer
    if not success:
        raise Refusal(code, text)
