"""`archgen import` of ReqIF: the requirements of a file, with those of the project that came from it before found again."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from archgen.plugin.importing import ImportedRequirements
from archgen.plugin.model import Requirement
from archgen.plugins.reqif.known_requirements import find_known_requirements
from archgen.plugins.reqif.reqif_files import read_reqif_file
from archgen.plugins.reqif.requirement_mapping import take_requirements


def read_requirements(file: Path, requirements: Iterable[Requirement]) -> ImportedRequirements:
    """Return the requirements of a file; those that the project has keep their ids. Raise ForeignFileError and OSError."""
    return take_requirements(read_reqif_file(file), find_known_requirements(requirements))
