"""ReqIF: requirements of other tools."""

PLUGIN = {
    "api": 1,
    "page": "docs/requirements.md",
    "importers": {
        "reqif": {
            "rank": 1,
            "summary": "requirements of Doors, Polarion and others (.reqif, .reqifz)",
            "endings": (".reqif", ".reqifz"),
            "reader": "archgen.plugins.reqif.reqif_import:read_requirements",
            "has_requirements": True,
        },
    },
}
