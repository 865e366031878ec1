# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A node's log beside something that is drawn on the same terminal."""


class Log:
    """
    A logger of rclpy that puts aside what is on the terminal while it writes a line.

    aside: function that returns a context manager, within which the terminal is free. rclpy
    tells calls apart by where they are made, and each keeps its severity and its filters.
    """

    def __init__(self, logger, aside):
        self._logger, self._aside = logger, aside

    def __getattr__(self, name):
        return getattr(self._logger, name)

    def info(self, text):
        """Write a line that tells what happens."""
        with self._aside():
            self._logger.info(text)

    def warning(self, text, throttle_duration_sec=None):
        """Write a warning; throttle_duration_sec: no other such one for so long."""
        with self._aside():
            if throttle_duration_sec is None:
                self._logger.warning(text)
            else:
                self._logger.warning(text, throttle_duration_sec=throttle_duration_sec)

    def error(self, text):
        """Write what went wrong."""
        with self._aside():
            self._logger.error(text)
