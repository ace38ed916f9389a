"""Importers turn other formats into plain data of the language. So far: tables, from CSV files, workbooks and documents."""

from archgen.importers.column_headings import parse_heading_map
from archgen.importers.table_cells import MAX_OFFICE_BYTES as MAX_BYTES
from archgen.importers.table_import import ImportResult, import_tables

__all__ = ["MAX_BYTES", "ImportResult", "import_tables", "parse_heading_map"]
