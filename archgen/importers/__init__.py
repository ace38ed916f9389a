"""Importers turn other formats into plain data of the language. So far: tables, as spreadsheets export them."""

from archgen.importers.table_cells import MAX_BYTES
from archgen.importers.table_import import ImportResult, import_tables

__all__ = ["MAX_BYTES", "ImportResult", "import_tables"]
