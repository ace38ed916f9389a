"""Find the files that ship with archgen beside its code: schemas, backends, the type mapper, examples."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def root() -> Path:
    """Return the folder with `schemas/`, `backends/`, `start/`, `ros_type_mapper.yaml` and `example_ramcip/`.

    It is `archgen/_data` in an installed wheel, and the top of the repository in a checkout.
    """
    packed = _PACKAGE / "_data"
    return packed if packed.is_dir() else _PACKAGE.parent


def path(*parts: str) -> Path:
    """Return the path of a shipped file or folder."""
    return root().joinpath(*parts)
