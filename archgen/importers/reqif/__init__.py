"""Read requirements from ReqIF, as Doors, Polarion and their like exchange them."""

from archgen.importers.reqif.reqif_files import read_reqif_file
from archgen.importers.reqif.requirement_mapping import ImportedRequirements, take_requirements

__all__ = ["ImportedRequirements", "read_reqif_file", "take_requirements"]
