"""Read files in AADL as slices of the language, with an account of all that was not taken.

Tell what was read of a model and not taken: properties, annexes, calls, and what counts in some modes alone.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.importing import ForeignFileError, ForeignImport, Span, read_bounded
from archgen.plugins.aadl.aadl_data_types import AadlDataTypes
from archgen.plugins.aadl.aadl_tree import AadlConnection, AadlFlow, AadlProperty, Classifier, Modes, Subcomponent
from archgen.plugins.aadl.archgen_words import find_own_text
from archgen.plugins.aadl.classifier_names import ClassifierNames, KnownClassifier, fold_property_name
from archgen.plugins.aadl.component_bodies import Body, ComponentBuilder, TooManyPartsError, map_node_ports
from archgen.plugins.aadl.hardware_mapping import HardwareMapper
from archgen.plugins.aadl.import_notes import NoteList
from archgen.plugins.aadl.package_parsing import ParsedText, parse_text
from archgen.plugins.aadl.property_values import PropertyScope
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver
from archgen.plugins.aadl.robot_groups import GroupBuilder, ModelRoots
from archgen.plugins.aadl.structures import ClassifierStructure, PortMapper, StructureFinder
from archgen.plugins.aadl.system_walk import (
    MAX_INSTANCES,
    ChainMapper,
    NodeWriter,
    TooManyInstancesError,
    find_instances,
)
from archgen.plugins.aadl.token_cursor import MAX_TOKENS, AadlText, TooManyTokensError

_TAKEN_PROPERTIES = frozenset(
    [
        *("dispatch_protocol", "period", "deadline", "dispatch_jitter", "compute_execution_time", "priority"),
        *("queue_size", "source_text", "source_name", "scheduling_protocol", "latency", "transmission_time"),
        *("actual_processor_binding", "actual_connection_binding", "data_size", "source_data_size"),
        *("topic_properties::name", "topic_properties::default_name"),
        *("sei::bandwidthcapacity", "bus_properties::bandwidth"),
        *(f"data_model::{name}" for name in ("data_representation", "enumerators", "element_names", "base_type")),
    ]
)
"""What is taken of some elements."""


def tell_untaken(resolver: ClassifierResolver) -> None:
    """Tell all that was left out."""
    names, notes = resolver.names, resolver.notes
    written_over = resolver.used | resolver.overridden
    known_sets = frozenset(names.property_sets)
    for known in names.known.values():
        classifier = known.classifier
        for name, span in classifier.annexes:
            notes.add_counted(f"annex {name}", "the text of annexes is not read", span)
        for association in _list_associations(classifier):
            if not known.is_of_library and id(association) not in written_over and not _is_computed(association, names):
                _tell_property(association, known_sets, notes)
            elif id(association) in resolver.used:
                _tell_values(association, notes)
        _tell_modes(known, notes)
        if classifier.calls and classifier.category != "subprogram":
            notes.add_counted("calls", "sequences of calls are not taken", classifier.span)
    for package in names.packages.values():
        for name, span in package.annexes:
            notes.add_counted(f"annex {name}", "the text of annexes is not read", span)
        for association in package.properties:
            _tell_property(association, known_sets, notes)


def _list_associations(classifier: Classifier) -> list[AadlProperty]:
    found = list(classifier.properties)
    elements = (classifier.features, classifier.subcomponents, classifier.connections, classifier.flows)
    for written in elements:
        found += [association for element in written for association in element.properties]
    return found


def _is_computed(association: AadlProperty, names: ClassifierNames) -> bool:
    """Whether a tool has computed a property: what archgen writes of flows and connections is, too."""
    name = fold_property_name(association.name)
    return name == "actual_latency" or (names.is_own and name == "latency")


def _tell_property(association: AadlProperty, known_sets: frozenset[str], notes: NoteList) -> None:
    name = fold_property_name(association.name)
    set_name = name.rpartition("::")[0]
    if set_name == "archgen":
        return
    words = "archgen has no word for this property"
    if name in _TAKEN_PROPERTIES:
        words = "it is not taken here: what it is said of is used nowhere, or has no word for it"
    elif set_name and set_name not in known_sets:
        words = f"the property set {set_name} is in none of the files, and archgen has no word for this property"
    notes.add_counted(f"property {association.name}", words, association.span)


def _tell_values(association: AadlProperty, notes: NoteList) -> None:
    """Tell a property that was taken as it is in some modes."""
    name, others = association.name, association.other_values
    if others:
        values = f"{len(others) + 1} values, each for other modes"
        words = f"{name} has {values}; the one of the initial mode counts, else that of no mode, else the first"
    elif association.modes:
        words = f"{name} has this value in {_name_modes(association.modes)}; here it counts always"
    else:
        return
    notes.add("in modes", words, association.span, fate="noted")


def _tell_modes(known_classifier: KnownClassifier, notes: NoteList) -> None:
    """Tell what stands in some modes alone, each at its place."""
    classifier = known_classifier.classifier
    if classifier.modes:
        words = "archgen has no modes: what changes when one follows another is not taken"
        notes.add_counted("modes", words, classifier.span)
    for element, kind in _list_elements(classifier):
        if element.modes:
            words = (
                f"{kind} {element.name}".strip() + f" is there in {_name_modes(element.modes)}; here it counts always"
            )
            notes.add("in modes", words, element.span, fate="noted")


def _list_elements(classifier: Classifier) -> Iterator[tuple[Subcomponent | AadlConnection | AadlFlow, str]]:
    yield from ((part, part.category) for part in classifier.subcomponents)
    yield from ((connection, "connection") for connection in classifier.connections)
    yield from ((flow, "flow") for flow in classifier.flows)


def _name_modes(modes: Modes) -> str:
    names = modes if len(modes) < 5 else (*modes[:3], f"{len(modes) - 3} others")  # noqa: PLR2004 - what reads well
    if len(names) == 1:
        return f"mode {names[0]} alone"
    return f"modes {', '.join(names[:-1])} and {names[-1]} alone"


def read_aadl(files: Sequence[Path]) -> ForeignImport:
    """Return what files in AADL say. Raise ForeignFileError for one that cannot be read at all."""
    notes = NoteList()
    names = ClassifierNames()
    tokens_left = MAX_TOKENS
    texts = [each for file in files for each in _list_texts(file)]
    for file in texts:
        parsed = _read_file(file, notes, tokens_left, is_alone=len(texts) == 1)
        tokens_left -= parsed.token_count
        names.add_packages(parsed.packages)
        names.add_property_sets(parsed.property_sets)
    for name, span, first in names.repeated:
        notes.add_contradiction(
            "duplicate", f"{name} is declared a second time, first in {first}; the first counts", span
        )
    return _ModelImport(names, notes).make_import()


_MAX_FILES = 5_000


def _list_texts(path: Path) -> list[Path]:
    """Return the files in AADL that a folder holds, links left out; a file is itself. Raise ForeignFileError."""
    if not path.is_dir():
        return [path]
    found: list[Path] = []
    for folder, folders, names in os.walk(path):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        files = (Path(folder, name) for name in sorted(names) if name.endswith(".aadl"))
        found += [each for each in files if each.is_file() and not each.is_symlink()]
        if len(found) > _MAX_FILES:
            words = f"it holds more than {_MAX_FILES:,} files in AADL"
            raise ForeignFileError(words, Span.of_file(str(path)), "give the folders of the packages that you need")
    if not found:
        words = "no file in it is called `.aadl`"
        raise ForeignFileError(words, Span.of_file(str(path)), "give the folder of the model, or its files")
    return found


def _read_file(file: Path, notes: NoteList, max_tokens: int, *, is_alone: bool) -> ParsedText:
    text = _decode_text(str(file), read_bounded(file), notes)
    try:
        parsed = parse_text(str(file), text, max_tokens)
    except TooManyTokensError as error:
        words = f"up to here the model has more than {MAX_TOKENS:,} words and signs"
        span = AadlText(str(file), text).span(error.offset, error.offset + 1)
        raise ForeignFileError(words, span, "import the packages that you need") from None
    if not parsed.packages and not parsed.property_sets:
        fault = parsed.faults[0] if parsed.faults else None
        words = "there is no AADL in it: neither a package nor a property set"
        place = fault.span if fault else Span.of_file(str(file))
        help_line = "an AADL file begins with `package NAME public`"
        if is_alone:
            raise ForeignFileError(words, place, help_line)
        notes.add("file", words, place, help_line)
        return parsed
    for fault in parsed.faults:
        notes.add("syntax", fault.message, fault.span, fault.help_line or "mend it, or leave it out")
    if parsed.unpackaged is not None:
        words = "what stands in no package is of AADL's first version; it is read all the same"
        notes.add("AADL 1", words, parsed.unpackaged.span, fate="noted")
    return parsed


def _decode_text(file: str, data: bytes, notes: NoteList) -> str:
    """Return the text of a file. Raise ForeignFileError for what is no text."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif b"\x00" in data:
        raise ForeignFileError("it is no text", Span.of_file(file), "save it as UTF-8")
    else:
        encoding = "utf-8-sig"
    try:
        return data.decode(encoding).replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        if encoding == "utf-16":
            raise ForeignFileError("it is no text in UTF-16", Span.of_file(file), "save it as UTF-8") from None
        line = data.count(b"\n", 0, error.start) + 1
        span = Span(file, line, 1, line, 2)
        notes.add(
            "encoding", "this is no UTF-8; the file is read as windows-1252", span, "save it as UTF-8", fate="noted"
        )
        return data.decode("cp1252", "replace").replace("\r\n", "\n").replace("\r", "\n")


class _ModelImport:
    """The mapping of a model, step by step."""

    def __init__(self, names: ClassifierNames, notes: NoteList) -> None:
        self._names, self._notes = names, notes
        self._resolver = ClassifierResolver(names, notes)
        self._types = AadlDataTypes(self._resolver)
        self._finder = StructureFinder(self._resolver, PortMapper(self._resolver, self._types))

    def make_import(self) -> ForeignImport:
        """Return the slices, what was taken, and the notes."""
        data_count = self._types.add_all()
        roots = ModelRoots(self._resolver, self._finder)
        builder = ComponentBuilder(self._resolver, roots.find_type_id)
        groups = GroupBuilder(self._resolver, roots, builder)
        nodes = NodeWriter()
        hardware = HardwareMapper(self._resolver)
        chains = ChainMapper(self._notes)
        component_types: dict[str, Body] = {}
        try:
            for type_id, structure in roots.types.items():
                component_types[type_id] = self._build_type(structure, builder)
            for root in roots.roots:
                groups.add_root(root)
            for system in groups.systems:
                find_instances(system, roots)
                nodes.add_nodes(system, hardware.map_system(system))
                if system.lone_buses and system.frames:
                    hints = groups.groups[system.frames[-1].group_id]["hints"]["aadl"]
                    hints["buses"] = system.lone_buses
                chains.add_chains(system)
        except (TooManyPartsError, TooManyInstancesError):
            span = roots.roots[0].resolved.known.classifier.span if roots.roots else Span.of_file("")
            words = f"written out, its systems have more than {MAX_INSTANCES:,} parts"
            raise ForeignFileError(words, span, "import the systems that you need") from None
        for type_id, structure in roots.types.items():
            if base := roots.find_base_id(structure):
                component_types[type_id] = _subtract_base(component_types[type_id], base, component_types)
        bodies = {name: body for name, body in groups.groups.items() if body["components"]}
        owners = sorted({owner for part in (bodies, component_types) for owner in _list_owners(part)})
        slices: dict[str, Mapping[str, Any]] = {
            "partners.yaml": _make_slice(partners={owner: {} for owner in owners}),
            "types.yaml": _make_slice(types=self._types.types),
            "component_types.yaml": _make_slice(component_types=component_types),
            "groups.yaml": _make_slice(groups=bodies),
            "nodes.yaml": _make_slice(nodes=nodes.nodes),
            "hosts.yaml": _make_slice(hosts=hardware.hosts, containers=hardware.containers, links=hardware.links),
            "chains.yaml": _make_slice(chains=chains.chains),
        }
        taken = self._count_taken(roots, data_count)
        taken |= {"processor": len(hardware.hosts), "bus": len(hardware.links), "end to end flow": len(chains.chains)}
        tell_untaken(self._resolver)
        title = next((find_own_text(system.scope, (), "title") for system in groups.systems), "")
        if not title and len(self._names.packages) == 1:
            title = next(iter(self._names.packages.values())).name
        distro = next((find_own_text(system.scope, (), "distro") for system in groups.systems), "")
        return ForeignImport(
            {name: section for name, section in slices.items() if section},
            {name: count for name, count in taken.items() if count},
            self._notes.list_notes(),
            title,
            distro,
        )

    def _build_type(self, structure: ClassifierStructure, builder: ComponentBuilder) -> Body:
        scope = PropertyScope(self._resolver, structure.resolved)
        body = builder.build_body(structure, scope)
        if structure.is_node:
            node = map_node_ports(structure, scope, is_type=True)
            whole = {"whole": True} if structure.parts else {}
            body |= {"node": {**whole, **node}} if whole or node else {}
        return body

    def _count_taken(self, roots: ModelRoots, data_count: int) -> dict[str, int]:
        counts: Counter[str] = Counter()
        seen: set[int] = set()
        waiting = [*roots.roots, *roots.types.values()]
        while waiting:
            structure = waiting.pop()
            if id(structure) in seen:
                continue
            seen.add(id(structure))
            counts[structure.resolved.category] += 1
            counts["thread"] += structure.thread is not None
            counts["port"] += len(structure.ports.ports)
            counts["connection"] += len({id(wire.connection) for wire in structure.wires})
            waiting += [part.structure for part in structure.parts.values() if part.structure]
        counts["data"] = data_count
        return dict(sorted(counts.items()))


def _list_owners(bodies: Mapping[str, Body]) -> Iterator[str]:
    """Yield the owners of groups and components, to any depth."""
    for body in bodies.values():
        if "owner" in body:
            yield body["owner"]
        yield from _list_owners(body.get("components", {}))


def _make_slice(**sections: Mapping[str, Any]) -> dict[str, Any]:
    return {key: section for key, section in sections.items() if section}


def _subtract_base(body: Body, base_id: str, component_types: Mapping[str, Body]) -> Body:
    """Return a component type as made from another one: what it says otherwise than that."""
    base = _write_whole(component_types[base_id], component_types)
    if _adds_inside(body, base):
        # A part was refined to one that has more: what is made from a type adds nothing inside of its parts.
        return body
    return {"is": base_id, **_subtract_body(body, base)}


def _adds_inside(body: Body, base: Body) -> bool:
    """Whether a part of both has ports or parts here that it has not in the base."""
    for name, part in body.get("components", {}).items():
        known = base.get("components", {}).get(name)
        if known is None:
            continue
        if any(part.get(key, {}).keys() - known.get(key, {}).keys() for key in ("inputs", "outputs", "components")):
            return True
        if _adds_inside(part, known):
            return True
    return False


def _write_whole(body: Body, component_types: Mapping[str, Body]) -> Body:
    """Return a component type with all that it has from what it is made from."""
    base_id = body.get("is")
    if not base_id:
        return body
    return _add_over(
        _write_whole(component_types[base_id], component_types), {k: v for k, v in body.items() if k != "is"}
    )


def _add_over(base: Body, body: Body) -> Body:
    merged = dict(base)
    for key, value in body.items():
        both = isinstance(value, dict) and isinstance(merged.get(key), dict)
        merged[key] = _add_over(merged[key], value) if both else value
    return merged


def _subtract_body(body: Body, base: Body) -> Body:
    left: Body = {}
    for key, value in body.items():
        if key not in base:
            left[key] = value
        elif isinstance(value, dict) and isinstance(base[key], dict):
            if inner := _subtract_body(value, base[key]):
                left[key] = inner
        elif value != base[key]:
            left[key] = value
    return left
