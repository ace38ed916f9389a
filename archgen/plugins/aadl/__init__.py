"""AADL: models in text, packages and their systems, read and written."""

PLUGIN = {
    "api": 1,
    "page": "docs/aadl.md",
    "importers": {
        "aadl": {
            "rank": 2,
            "summary": "models in AADL v2, as text (.aadl)",
            "endings": (".aadl",),
            "reader": "archgen.plugins.aadl.aadl_import:read_aadl",
        },
    },
    "views": {"aadl": "archgen.plugins.aadl.views.aadl_view:make_view"},
}
