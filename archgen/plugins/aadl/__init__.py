"""AADL: models in text, packages and their systems."""

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
}
