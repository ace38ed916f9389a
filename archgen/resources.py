"""Find what ships with archgen beside its Python: schemas, backends, the type mapper, data, the font."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def root() -> Path:
    """Give the folder that holds `schemas/`, `backends/`, `ros_type_mapper.yaml` and `example_ramcip/`.

    In a wheel they lie in `archgen/_data`; in a checkout, at its top.
    """
    packed = _PACKAGE / "_data"
    return packed if packed.is_dir() else _PACKAGE.parent


def path(*parts: str) -> Path:
    """Give the path of one shipped file or folder."""
    return root().joinpath(*parts)
