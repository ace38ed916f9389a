"""Find the files that ship with archgen beside its code: schemas, backends, the type mapper, examples."""

from __future__ import annotations

from pathlib import Path

_PACKAGE_FOLDER = Path(__file__).resolve().parent


def resource_root() -> Path:
    """Return the folder with `schemas/`, `backends/`, `start/`, `ros_type_mapper.yaml` and `example_ramcip/`.

    It is `archgen/_data` in an installed wheel, and the top of the repository in a checkout.
    """
    data_folder = _PACKAGE_FOLDER / "_data"
    return data_folder if data_folder.is_dir() else _PACKAGE_FOLDER.parent


def resource_path(*path_parts: str) -> Path:
    """Return the path of a shipped file or folder."""
    return resource_root().joinpath(*path_parts)
