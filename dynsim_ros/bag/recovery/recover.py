# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
"""A bag that was interrupted or damaged made whole, so that nothing is lost on the way."""

from __future__ import annotations

from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import datetime, timezone
import fcntl
import os
from pathlib import Path
import stat

from mcap.records import Metadata

from .rebuild import Rebuild
from .stretches import Hole
from .survey import Survey
from ..bag_names import first_free
from ..gap import MISSING
from ..output import Output, sync_folder
from ..sources import BagError
from ..summary import Summary, write_record
from ... import __version__

RECOVERED_METADATA = 'recovered'


@dataclass
class Recovered:
    """
    What came of a recovery.

    path: of the bag, which is whole now; messages: how many are in it; first_ns, last_ns: their
    log times, None where there are none; holes: what is missing; was_whole: whether nothing had
    to be done; kept: where the damaged file is now, None if everything in it is in the bag.
    """

    path: Path
    messages: int
    first_ns: int | None
    last_ns: int | None
    holes: list[Hole]
    was_whole: bool = False
    kept: Path | None = None


def recover(path: str | os.PathLike, output: str | os.PathLike | None = None) -> Recovered:
    """
    Make an MCAP file whole: all that is intact in it can be read by every reader then.

    output: where the whole file goes, which must not exist, and the other one stays as it is. If
    None, the file is replaced: at the end, at once, and kept under another name if anything is
    missing. One that is only cut off is not copied but finished where it is. Whenever this is
    interrupted, everything is still there, and it can be done again. Raises BagError, in one
    line, for what is no bag, or is being written.
    """
    path = Path(path)
    if path.is_symlink():
        # It is not what is replaced.
        path = path.resolve()
    try:
        with _opened(path, output is not None) as (file, size):
            return _Recovery(path, file, size).run(output and Path(output))
    except OSError as error:
        raise BagError(f'{error.filename or path}: {error.strerror or error}') from None


@contextmanager
def _opened(path, only_to_read):
    """Give a file, open and locked, and its size."""
    file = os.open(path, (os.O_RDONLY if only_to_read else os.O_RDWR) | os.O_NONBLOCK
                   | os.O_CLOEXEC)
    try:
        found = os.fstat(file)
        if not stat.S_ISREG(found.st_mode):
            raise BagError(f'{path} is not a file')
        if not found.st_size:
            raise BagError(f'{path} is empty')
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise BagError(f'{path} is being written, or recovered, by another process') from None
        except OSError as error:
            if not only_to_read:
                raise BagError(f'{path} cannot be locked ({error.strerror}): recover it to '
                               'another file, with --output') from None
        # Another process may have replaced it before it was locked.
        if not os.path.samestat(os.stat(path), found):
            raise BagError(f'{path} is being recovered by another process')
        yield file, found.st_size
    finally:
        os.close(file)


class _Recovery:
    """Of one file, which is open and locked."""

    def __init__(self, path, file, size):
        self._path, self._file, self._size = path, file, size

    def run(self, output):
        """Return a Recovered."""
        folder = (output or self._path).parent
        with open(self._file, 'rb', closefd=False) as stream, Summary(folder) as summary:
            survey = Survey(stream, self._size, summary)
            if survey.header is None and not survey.messages:
                raise BagError(f'{self._path} is not an MCAP file')
            self._result = Recovered(output or self._path, survey.messages, survey.first_ns,
                                     survey.last_ns, survey.holes, survey.is_whole)
            if survey.is_whole and output is None:
                return self._result
            if survey.is_cut and output is None:
                self._finish_in_place(survey)
            else:
                self._copy(stream, survey, output)
        return self._result

    def _finish_in_place(self, survey):
        """Put the end behind what is intact."""
        for (opcode, _), record in survey.declared.items():
            survey.summary.note_declared(opcode, record)
        output = Output.go_on(self._path, os.dup(self._file), survey.end)
        try:
            if survey.torn is not None:
                indexes = survey.torn.indexes
                output.write(b''.join(indexes.values()))
                survey.summary.note_chunk(survey.torn.place(survey.torn.record.start),
                                          {key: len(index) for key, index in indexes.items()})
            self._finish(output, survey.summary, survey.gaps)
        finally:
            output.close()

    def _copy(self, stream, survey, target):
        """Write all that is intact to another file, and put it in the place of this one."""
        path = target or self._path.with_name(f'.{self._path.name}.recovering')
        if target is None:
            # Of a recovery that was interrupted: nobody else is at it.
            with suppress(FileNotFoundError):
                path.unlink()
        output = Output(path)
        try:
            with Summary(path.parent) as summary:
                Rebuild(stream, self._size, survey, output, summary)
                self._finish(output, summary, survey.gaps)
            if target is None:
                self._replace(path)
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        finally:
            output.close()

    def _finish(self, output, summary, gaps):
        """Write down what is missing, beside what was before, and the end of the file."""
        self._result.messages = summary.messages
        holes = self._result.holes
        for number, hole in enumerate(holes, gaps + 1):
            write_record(output, summary, Metadata(f'{MISSING}{number}', hole.values()))
        write_record(output, summary, Metadata(RECOVERED_METADATA, {
            'version': __version__, 'missing': str(len(holes)),
            'recovered_at': datetime.now(timezone.utc).isoformat(timespec='seconds')}))
        summary.write(output)
        output.sync()
        sync_folder(self._result.path.parent)

    def _replace(self, path):
        """Put a file that is on the disk in the place of this one."""
        if not all(hole.is_cut for hole in self._result.holes):
            self._result.kept = self._keep()
        os.replace(path, self._path)
        sync_folder(path.parent)

    def _keep(self):
        """Give the damaged file another name; return that."""
        kept = first_free(self._path.with_name(f'{self._path.name}.damaged{suffix}')
                          for suffix in ('', *(f'_{i}' for i in range(2, 1000))))
        try:
            os.link(self._path, kept)
        except OSError:
            # A file system where no file has two names.
            os.rename(self._path, kept)
        return kept
