"""The generator of what starts and stops a system: scripts, units of systemd, files for compose."""

PLUGIN = {
    "api": 1,
    "page": "docs/start_up.md",
    "views": {"plan": "archgen.plugins.start_scripts.start_plan_view:make_view"},
}
