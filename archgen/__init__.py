"""archgen: design a robot's software architecture together, in git.

The public Python API is `archgen.load(path)`; everything else hangs on the `Project` that it returns.
"""

from __future__ import annotations

# Known to type checkers by its name. Importing `typing` takes longer than all else here, and an interrupt in it shows a
# traceback: nothing of archgen's can catch it yet.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from archgen.api import Project, load

__all__ = ["Project", "__version__", "load"]
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    """Import the API on first use only, so that `archgen --help` starts fast."""
    if name in {"Project", "load"}:
        from archgen import api

        return getattr(api, name)
    raise AttributeError(f"module 'archgen' has no attribute {name!r}")
