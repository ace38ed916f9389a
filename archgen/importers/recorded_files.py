"""What a reader of recordings returns: observations of a design's elements, and what has no place in it."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.frozen import dataclass
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.chains.sample_statistics import UnmappedSamples


class RecordingRefusedError(Exception):
    """What was named is no recording that can be read; the text says what to do."""


@dataclass(frozen=True, slots=True)
class ReadRecordings:
    """What recordings say of a design's elements, and what of them has no place in it.

    `texts` holds the files that people wrote, for excerpts in findings; recordings may be far too large for that.
    """

    observations: tuple[Observation, ...]
    unmapped: tuple[UnmappedSamples, ...]
    diagnostics: tuple[Diagnostic, ...]
    texts: tuple[tuple[str, str], ...]
