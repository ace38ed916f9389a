"""Generators for other middlewares than ROS, and of programs that run the architecture in logical time."""

PLUGIN = {
    "api": 1,
    "page": "docs/middlewares.md",
    "views": {
        "simulation": "archgen.plugins.middlewares.simulation_view:make_view",
        "middleware": "archgen.plugins.middlewares.middleware_view:make_view",
    },
}
