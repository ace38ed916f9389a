"""UML: models in XMI of several tools, and one in Eclipse UML2's form to write."""

PLUGIN = {
    "api": 1,
    "page": "docs/uml.md",
    "importers": {
        "xmi": {
            "rank": 3,
            "summary": "UML models in XMI 2 (.xmi, .uml, .mdzip): components, classes, nodes",
            "endings": (".xmi", ".uml", ".mdzip", ".zargo"),
            "reader": "archgen.plugins.xmi.xmi_import:read_xmi",
            "keeps_ids": True,
        },
    },
    "views": {"uml": "archgen.plugins.xmi.views.uml_view:make_view"},
}
