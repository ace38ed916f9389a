"""Limits of what templates may use, and how the process that runs them is bound to them."""

from __future__ import annotations

import contextlib
import sys

from archgen.frozen import dataclass

MAX_TEMPLATE_BYTES = 1_000_000


@dataclass(frozen=True, slots=True)
class TemplateLimits:
    """Limits for one backend: seconds of computing, seconds in all, bytes of memory, characters of output, number of
    files.
    """

    computing: int = 20
    # Where computing is bound, a worker that waits is one of a busy machine, and comes to its end.
    waiting: float = 60.0 if sys.platform == "win32" else 900.0
    memory: int = 1_000_000_000
    output: int = 64_000_000
    files: int = 20_000

    def scale_to(self, element_count: int) -> TemplateLimits:
        """Return the limits for a project with so many components and nodes: more for a large one, within bounds of their own."""
        factor = min(max(element_count / _FREE_ELEMENTS, 1), _MAX_FACTOR)
        return TemplateLimits(
            round(self.computing * factor),
            self.waiting * factor,
            min(round(self.memory * factor), max(self.memory, _MAX_MEMORY)),
            round(self.output * factor),
            round(self.files * factor),
        )


_FREE_ELEMENTS = 2_500
"""With more components and nodes the limits grow, ten times at most."""
_MAX_FACTOR = 10
_MAX_MEMORY = 4_000_000_000


def confine_process(limits: TemplateLimits) -> None:
    """Bind this process: computing time, memory, no files written, few open ones.

    Systems without such limits (Windows) still have the time in all, which the parent process watches, and the output.
    """
    with contextlib.suppress(ImportError):
        import resource

        for resource_kind, bound in (
            (resource.RLIMIT_CPU, limits.computing),
            (resource.RLIMIT_AS, limits.memory),
            (resource.RLIMIT_FSIZE, 0),
            (resource.RLIMIT_CORE, 0),
            (resource.RLIMIT_NOFILE, 32),
        ):
            with contextlib.suppress(ValueError, OSError):  # a tighter limit than ours is in force already
                resource.setrlimit(resource_kind, (bound, bound))
