"""Orca Robotics: definition files of components, and configurations to write."""

PLUGIN = {
    "api": 1,
    "page": "docs/middlewares.md",
    "importers": {
        "orca": {
            "rank": 9,
            "summary": "components of the Orca Robotics project, from their definition files (.def)",
            "endings": (),
            "reader": "archgen.plugins.orca.orca_import:read_orca",
        },
    },
}
