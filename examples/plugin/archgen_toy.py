"""An importer and a rule for archgen, as a package of its own: docs/plugins.md walks through it."""

from archgen.plugin.findings import Diagnostic, Severity
from archgen.plugin.importing import ForeignImport, make_id


def read_toy(files):
    """Read a list of names, one a line: each becomes a component type."""
    names = [line.strip() for file in files for line in file.read_text(encoding="utf-8").splitlines() if line.strip()]
    types = {make_id(name, "component"): {"title": name} for name in names}
    return ForeignImport({"toy_types.yaml": {"component_types": types}}, {"line": len(names)}, title="Toys")


PLUGIN = {"api": 1, "summary": "a list of names (.toy)", "endings": (".toy",), "reader": "archgen_toy:read_toy"}


def unowned_component(architecture):
    """A component has no owner.

    Why: Nobody answers for it.
    """
    for component in architecture.components.values():
        if not component.owners:
            message = f"`{component.id}` has no owner"
            yield Diagnostic("unowned-component", message, component.at, help="write `owner`", element=component.id)


RULES = {"api": 1, "rules": ((unowned_component, Severity.WARNING),)}
