"""The errors of reading two versions that are compared."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.frozen import NamedTuple


class ReadingErrors(NamedTuple):
    """The errors of reading and linking either version: what they are about is missing in the comparison."""

    before: tuple[Diagnostic, ...] = ()
    after: tuple[Diagnostic, ...] = ()
