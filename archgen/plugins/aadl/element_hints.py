"""What archgen has no word for is kept as hints (docs/aadl.md, Hints)."""

from __future__ import annotations

from pathlib import Path as FilePath
from typing import Any

from archgen.plugins.aadl.aadl_tree import AadlProperty, Path
from archgen.plugins.aadl.import_notes import NoteList
from archgen.plugins.aadl.property_values import PropertyScope, read_first_text, read_texts, read_time_range
from archgen.plugins.aadl.resolved_classifiers import ResolvedClassifier, ResolvedPart
from archgen.plugins.aadl.structures import ClassifierStructure


def keep_sources(scope: PropertyScope, path: Path) -> dict[str, Any]:
    """Return the hints of Source_Text and Source_Name at a path."""
    hints: dict[str, Any] = {}
    if texts := read_texts(scope.value(path, "source_text")):
        hints["source_text"] = texts
    if text := read_first_text(scope.value(path, "source_name")):
        hints["source_name"] = text
    return hints


def keep_thread(scope: PropertyScope, path: Path, thread: ResolvedClassifier | None) -> dict[str, Any]:
    """Return the hints of a thread: what it is made from, its functions with header and entry."""
    is_own = scope.resolver.names.is_own
    hints: dict[str, Any] = {"classifier": thread.known.full_name} if thread and not is_own else {}
    functions: dict[str, dict[str, Any]] = {}
    for name, part in thread.parts.items() if thread else ():
        if part.category == "subprogram" and (sources := keep_sources(scope, (*path, name))):
            own = (
                {}
                if part.use.full_name.lower().rpartition("::")[2] in {"function", ""}
                else {"classifier": part.use.full_name}
            )
            functions[part.written.name] = own | sources
    return {**hints, **({"functions": functions} if functions else {})}


def keep_structure(structure: ClassifierStructure, scope: PropertyScope) -> dict[str, Any]:
    """Return the hints of what stands in a component beside its parts."""
    resolved = structure.resolved
    hints: dict[str, Any] = {}
    if resolved.annexes:
        hints["annexes"] = list(resolved.annexes)
    library_ports = {name for name, port in resolved.ports.items() if port.owner.is_of_library}
    used_ports = {
        end[0].lower()
        for connection in structure.access_connections.values()
        for end in (connection.source, connection.target)
        if len(end) == 1
    }
    kept_ports = {
        key: dict(value)
        for key, value in structure.ports.accesses.items()
        if key not in library_ports or (key in used_ports and not resolved.known.is_of_library)
    }
    if kept_ports and not (scope.resolver.names.is_own and resolved.category != "process"):
        hints["access"] = kept_ports
    library_names = {
        connection.name
        for known in resolved.ancestors
        if known.is_of_library
        for connection in known.classifier.connections
    }
    joined = {
        (connection.name or f"{'.'.join(connection.source)} -> {'.'.join(connection.target)}"): {
            "from": ".".join(connection.source),
            "to": ".".join(connection.target),
            "kind": connection.kind,
        }
        for connection in structure.access_connections.values()
        if connection.kind != "parameter" and connection.name not in library_names and not resolved.known.is_of_library
    }
    if not scope.resolver.names.is_own:
        if joined:
            hints["access_connections"] = joined
        if flows := _keep_flows(structure, scope):
            hints["flows"] = flows
    return hints | _keep_data(structure, scope)


def _keep_flows(structure: ClassifierStructure, scope: PropertyScope) -> dict[str, Any]:
    flows: dict[str, Any] = {}
    for (name, is_of_implementation), flow in structure.resolved.flows.items():
        if flow.kind == "end to end" or is_of_implementation or not flow.steps:
            continue
        ends = {"source": ("to",), "sink": ("from",), "path": ("from", "to")}[flow.kind]
        entry = {"kind": flow.kind, **{end: ".".join(step) for end, step in zip(ends, flow.steps, strict=False)}}
        lowest, highest = read_time_range(scope.value((name,), "latency"))
        if highest:
            entry |= {"latency": highest} if lowest == highest or not lowest else {"latency": f"{lowest} .. {highest}"}
        flows[flow.name] = entry
    return flows


def _keep_data(structure: ClassifierStructure, scope: PropertyScope) -> dict[str, Any]:
    hints: dict[str, Any] = {}
    for name, part in structure.resolved.parts.items():
        classifier = part.use.full_name
        if part.category == "data" and is_internal_state(part):
            state: dict[str, Any] = (
                {} if classifier.lower() in {"cnc::internal_state", "internal_state"} else {"classifier": classifier}
            )
            association = scope.find((name,), "source_text")
            if association and (texts := read_texts(association.value)):
                state = {"schema": texts[0], **state}
                check_schema_file(texts[0], association, scope.resolver.notes)
            if state:
                hints["internal_state"] = state
        elif part.category in {"data", "memory"}:
            key = "data" if part.category == "data" else "memories"
            sources = keep_sources(scope, (name,))
            hints.setdefault(key, {})[part.written.name] = ({"classifier": classifier} if classifier else {}) | sources
    return hints


def is_internal_state(part: ResolvedPart) -> bool:
    """Whether a data subcomponent is the internal state of a node, as the component-connector library has it."""
    type_name = part.use.full_name.lower().rpartition("::")[2].partition(".")[0]
    return "internal_state" in {part.written.name.lower(), type_name}


def check_schema_file(name: str, association: AadlProperty, notes: NoteList) -> None:
    """Tell of a schema that is not beside the AADL file or below it; no other place is looked at."""
    folder = FilePath(association.span.file).parent.resolve()
    help_line = "Source_Text names it from the folder of the AADL file"
    try:
        target = (folder / name).resolve()
        if not target.is_relative_to(folder):
            words = (
                f"the schema `{name}` of the internal state is not beside this file, so nobody looked whether it exists"
            )
        elif not target.is_file():
            words = f"there is no schema `{name}` of the internal state"
        else:
            return
    except (OSError, ValueError, RuntimeError):
        words = f"`{name}` is no name of a file"
    notes.add("internal_state", words, association.span, help_line, fate="noted")
