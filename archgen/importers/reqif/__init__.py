"""Read requirements from ReqIF, as Doors, Polarion and their like exchange them."""

from archgen.importers.reqif.known_requirements import find_known_requirements
from archgen.importers.reqif.reqif_files import read_reqif_file
from archgen.importers.reqif.requirement_mapping import ImportedRequirements, take_requirements

__all__ = ["ImportedRequirements", "find_known_requirements", "read_reqif_file", "take_requirements"]
