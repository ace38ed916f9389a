"""Importers turn other formats into plain data of the language. So far: tables, as spreadsheets export them."""

from archgen.importers.cells import MAX_BYTES
from archgen.importers.table import Imported, read

__all__ = ["MAX_BYTES", "Imported", "read"]
