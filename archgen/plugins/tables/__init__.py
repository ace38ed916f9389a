"""Tables of components and connections, as partners have them in CSV, workbooks and documents: `archgen init --from`."""

PLUGIN = {
    "api": 1,
    "page": "docs/howto.md",
    "readers": {
        "tables": "archgen.plugins.tables.table_import:read_tables",
        "headings": "archgen.plugins.tables.table_cells:parse_heading_map",
    },
}
