"""The view `interfaces`: packages of messages, services and actions that types of the project define by their fields."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping
from graphlib import TopologicalSorter

from archgen.plugin import replace
from archgen.plugin.findings import NO_SPAN, Diagnostic, Severity, Span
from archgen.plugin.generating import (
    CPP_KEYWORDS,
    PYTHON_KEYWORDS,
    GeneratedView,
    GenerationContext,
    collect_messages,
    tell_left_out,
    write_place,
)
from archgen.plugin.model import Architecture, ConceptualType, find_rings
from archgen.plugin.ros import Interface, InterfaceConstant, InterfaceField
from archgen.plugins.ros_code.package_facts import RosdepKeys, record_package_facts

_KINDS = ("msg", "srv", "action")


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the packages in an order in which each stands behind those that it uses, and all their files."""
    architecture, ros = context.architecture, context.ros_generation
    definers = _find_definers(architecture)
    findings = [*_find_untold_types(context), *_find_extended_packages(architecture, definers)]
    names = _list_generated(architecture, definers)
    sound_names, problems = _sort_out(architecture, names, definers, ros)
    findings += problems
    packages = _order_packages(sound_names, _find_used_packages(architecture, names))
    if not context.is_whole:
        wanted_packages = _find_wanted_packages(context, packages)
        packages = {name: files for name, files in packages.items() if name in wanted_packages}
        findings = [each for each in findings if _is_wanted(each, architecture, wanted_packages)]
    files = {
        name: record_definition(architecture.interfaces.definitions[name], definers.get(name), ros)
        for names in packages.values()
        for name in names
    }
    data = {
        "ros": ros,
        "packages": [
            _record_package(context, package, [files[name] for name in names], packages)
            for package, names in packages.items()
        ],
        "files": list(files.values()),
    }
    return GeneratedView(data, tuple(findings))


def find_refused_messages(architecture: Architecture, ros: int) -> Collection[str]:
    """Return the messages of the project's own that no package can have: nodes cannot use them either."""
    definers = _find_definers(architecture)
    names = _list_generated(architecture, definers)
    return set(names) - set(_sort_out(architecture, names, definers, ros)[0])


def tell_unlisted_packages(architecture: Architecture, used_packages: Collection[str]) -> Iterator[Diagnostic]:
    """Say which packages that programs use `ros_interfaces` would make where `generate` lists other backends alone."""
    listed = architecture.generate.backends
    if not listed or "ros_interfaces" in listed:
        return
    made = {name.partition("/")[0] for name in _list_generated(architecture, _find_definers(architecture))}
    for package_name in sorted(made & {*used_packages}):
        told = tell_left_out(
            f"programs need the package `{package_name}`, which no backend makes that `generate` lists",
            NO_SPAN,
            help_line="write `ros_interfaces:` below `backends`, or `status: existing` at its types if others make it",
        )
        yield replace(told, severity=Severity.NOTE)


def _list_generated(architecture: Architecture, definers: Mapping[str, ConceptualType]) -> list[str]:
    existing_packages = _list_existing_packages(architecture)
    return [
        name for name in _list_definitions(architecture, definers) if name.partition("/")[0] not in existing_packages
    ]


def _sort_out(
    architecture: Architecture, names: list[str], definers: Mapping[str, ConceptualType], ros: int
) -> tuple[list[str], list[Diagnostic]]:
    """Return the messages that can be written, and what is wrong with the others."""
    rings = find_rings(_find_used_packages(architecture, names))
    ring_names = [name for name in names if any(name.partition("/")[0] in ring for ring in rings)]
    sound_names, problems = _leave_out_unsound(architecture, names, ring_names, definers, ros)
    return sound_names, [*(_tell_ring(ring, names, definers) for ring in rings), *problems]


def _find_definers(architecture: Architecture) -> Mapping[str, ConceptualType]:
    """Return the types that define messages, by message."""
    definitions = architecture.interfaces.definitions
    return {
        each.message: each
        for each in architecture.types.values()
        if each.message and each.has_content and each.message in definitions
    }


def _list_definitions(architecture: Architecture, definers: Mapping[str, ConceptualType]) -> list[str]:
    """Return the messages of the packages that types define: a package has what files and `definitions` say, too."""
    packages = {name.partition("/")[0] for name in definers}
    shipped_packages = packages - architecture.interfaces.project_packages
    own_names = (
        name
        for name in sorted(architecture.interfaces.names)
        if (package := name.partition("/")[0]) in packages
        and package not in shipped_packages
        and name in architecture.interfaces.definitions
    )
    return sorted(own_names, key=lambda name: (name.partition("/")[0], _KINDS.index(name.split("/")[1]), name))


def _list_existing_packages(architecture: Architecture) -> Collection[str]:
    """Return the packages of which a message exists already: nothing is generated for them."""
    return {
        each.message.partition("/")[0]
        for each in architecture.types.values()
        if each.message and each.status == "existing"
    }


def _find_extended_packages(architecture: Architecture, definers: Mapping[str, ConceptualType]) -> Iterator[Diagnostic]:
    """Report messages that would have to be added to a package that exists already."""
    existing_packages = _list_existing_packages(architecture)
    for name, definer in definers.items():
        package = name.partition("/")[0]
        if package in existing_packages and definer.status != "existing":
            yield tell_left_out(
                f"`{name}` is not generated: the package `{package}` exists already",
                definer.at,
                element=definer.name,
                help_line="add it to that package by hand, or name a package of your own: `message: my_msgs/msg/Name`",
            )


def _find_untold_types(context: GenerationContext) -> Iterator[Diagnostic]:
    """Report the types at ports of ROS of which nobody says what is in their message."""
    architecture = context.architecture
    reported_types = set[str]()
    for component_id in context.wanted_components:
        for port in architecture.components[component_id].ports:
            mapped = architecture.types.get(port.type or "")
            if mapped is None or port.medium != "ros" or mapped.message or mapped.name in reported_types:
                continue
            reported_types.add(mapped.name)
            yield tell_left_out(
                f"nobody can generate the type `{mapped.name}`: it has no message and no fields",
                mapped.at if mapped.at != NO_SPAN else port.at,
                element=mapped.name,
                help_line="write what is in it, `fields: {x: float64}`, or the message that it is: `message: pkg/Name`",
            )


def _leave_out_unsound(
    architecture: Architecture,
    names: Iterable[str],
    told_names: Iterable[str],
    definers: Mapping[str, ConceptualType],
    ros: int,
) -> tuple[list[str], list[Diagnostic]]:
    """Return the messages that can be written, and what is wrong with the others: those that hold one of these go too.

    Of `told_names` somebody knows already that they are left out.
    """
    findings = list[Diagnostic]()
    reasons = dict.fromkeys(told_names, "")
    sound_names = [name for name in names if name not in reasons]
    definitions = architecture.interfaces.definitions
    while True:
        for name in sound_names:
            missing_words = [
                *_list_keywords(name, definitions[name]),
                *list_missing_words(definitions[name], ros),
                *(
                    f"`{message}`, which it holds, is left out"
                    for message in _list_messages(definitions[name])
                    if message in reasons
                ),
            ]
            if missing_words:
                reasons[name] = missing_words[0]
        left_out = [name for name in sound_names if name in reasons]
        if not left_out:
            return sound_names, findings
        for name in left_out:
            definer = definers.get(name)
            span = definer.at if definer else Span.of_file(name)
            element = definer.name if definer else None
            findings.append(tell_left_out(f"`{name}` is not generated: {reasons[name]}", span, element=element))
        sound_names = [name for name in sound_names if name not in reasons]


def _list_keywords(name: str, definition: Interface) -> Iterator[str]:
    """Yield what is called as no class or member can be in the code that ROS makes of a message."""
    for language, keywords in (("Python", PYTHON_KEYWORDS), ("C++", CPP_KEYWORDS)):
        if name.rpartition("/")[2] in keywords:
            yield f"its name is a word of {language}"
        yield from (
            f"its field `{each.name}` is a word of {language}"
            for part in definition.parts
            for each in part
            if each.name in keywords
        )


def _list_messages(definition: Interface) -> list[str]:
    """Return the messages that fields of a definition hold."""
    return [field.type for part in definition.parts for field in part if "/" in field.type]


def _find_used_packages(architecture: Architecture, names: Iterable[str]) -> dict[str, list[str]]:
    """Return the packages of these messages, in the order of their names, each with the others that it uses."""
    definitions = architecture.interfaces.definitions
    used_packages = defaultdict[str, set[str]](set)
    for name in names:
        used_packages[name.partition("/")[0]] |= {each.partition("/")[0] for each in _list_messages(definitions[name])}
    return {
        package: sorted((used & used_packages.keys()) - {package}) for package, used in sorted(used_packages.items())
    }


def _tell_ring(ring: Collection[str], names: Iterable[str], definers: Mapping[str, ConceptualType]) -> Diagnostic:
    """Report packages that hold messages of each other: none can be built before the other."""
    definer = next(definers[name] for name in names if name in definers and name.partition("/")[0] in ring)
    packages = " and ".join(f"`{package}`" for package in sorted(ring))
    return tell_left_out(
        f"the packages {packages} hold messages of each other, so that none can be built first: they are not generated",
        definer.at,
        element=definer.name,
        help_line="move types to one of them: `message: my_msgs/msg/Name`",
    )


def _order_packages(names: Iterable[str], used_packages: Mapping[str, list[str]]) -> dict[str, list[str]]:
    """Group messages by package; a package stands behind those that it uses, else in the order of their names."""
    names_by_package = defaultdict[str, list[str]](list)
    for name in names:
        names_by_package[name.partition("/")[0]].append(name)
    order = TopologicalSorter({package: used_packages[package] for package in names_by_package})
    return {package: names_by_package[package] for package in order.static_order() if package in names_by_package}


def _find_wanted_packages(context: GenerationContext, packages: Mapping[str, list[str]]) -> Collection[str]:
    """Return the packages that the wanted components use, with all that these hold: a package is made whole or not at all."""
    architecture = context.architecture
    port_types = dict.fromkeys(
        port.type
        for component_id in context.wanted_components
        for port in architecture.components[component_id].ports
        if port.type in architecture.types
    )
    types = [architecture.types[name] for name in port_types if name]
    topics = [
        topic
        for topic in architecture.topics.values()
        if any(each.node in context.wanted_nodes for each in (*topic.writers, *topic.readers))
    ]
    used_messages = collect_messages(architecture, types, topics)
    wanted = {message.partition("/")[0] for message in used_messages}
    # Behind one another: those that a wanted package uses stand before it.
    for package in reversed(list(packages)):
        if package in wanted:
            definitions = [architecture.interfaces.definitions[name] for name in packages[package]]
            wanted |= {m.partition("/")[0] for each in definitions for m in _list_messages(each)}
    return wanted


def _is_wanted(finding: Diagnostic, architecture: Architecture, wanted_packages: Collection[str]) -> bool:
    mapped = architecture.types.get(finding.element or "")
    return mapped is None or mapped.message is None or mapped.message.partition("/")[0] in wanted_packages


def _record_package(
    context: GenerationContext,
    package: str,
    files: list[dict[str, object]],
    packages: Mapping[str, list[str]],
) -> dict[str, object]:
    architecture = context.architecture
    names = packages[package]
    definitions = [architecture.interfaces.definitions[name] for name in names]
    kinds = {name.split("/")[1] for name in names}
    dependencies = list_used_packages(definitions, package, context.ros_generation)
    return {
        "name": package,
        **record_package_facts(context),
        "dependencies": dependencies,
        "rosdep_keys": RosdepKeys(architecture).list_keys(dependencies),
        "own_dependencies": [each for each in dependencies if each in packages],
        "files": [file["path"] for file in files],
        "messages": [name.split("/")[2] for name in names if "/msg/" in name],
        "services": [name.split("/")[2] for name in names if "/srv/" in name],
        "actions": [name.split("/")[2] for name in names if "/action/" in name],
        "has_actions": "action" in kinds,
    }


_ROS_1_TIMES = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
_ROS_2_TIMES = {ros_1_name: message for message, ros_1_name in _ROS_1_TIMES.items()}
_BOUND = re.compile(r"<=(\d+)")
_FIELD_TYPES = frozenset(
    (
        *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64"),
        "uint64",
    )
)
_KNOWN_WORDS = _FIELD_TYPES | {"string", "wstring"} | set(_ROS_2_TIMES)
_QUOTES = ('"', "'")


def record_definition(definition: Interface, definer: ConceptualType | None, ros: int) -> dict[str, object]:
    """Return an interface as a file has it; `ros` is the generation of ROS, `definer` the type that says its fields."""
    package, kind, name = definition.name.split("/")
    constants = definition.constants or ((),) * len(definition.parts)
    return {
        "package": package,
        "kind": kind,
        "name": name,
        "path": f"{kind}/{name}.{kind}",
        "place": write_place(definer.at) if definer else "",
        "type": definer.name if definer else "",
        "comment": (definer.comment if definer else None) or definition.comment,
        "parts": [
            {
                "name": part_name,
                "constants": [_record_constant(each, ros) for each in part_constants],
                "fields": [_record_field(each, package, ros) for each in fields],
            }
            for part_name, fields, part_constants in zip(
                definition.part_names, definition.parts, constants, strict=True
            )
        ],
    }


def list_missing_words(definition: Interface, ros: int) -> Iterator[str]:
    """Yield why a definition cannot be written for a generation of ROS."""
    for part in definition.parts:
        for field in part:
            base_type = field.type.partition("<=")[0]
            if base_type == "wstring" and ros == 1:
                yield f"ROS 1 has no `{base_type}`, which `{field.name}` is"
            elif "/" not in field.type and base_type not in _KNOWN_WORDS:
                yield f"nobody says what `{field.type}` is, which `{field.name}` holds"


def list_used_packages(definitions: Iterable[Interface], package: str, ros: int) -> list[str]:
    """Return the packages of the messages that definitions hold, but for their own; ROS 1 has times without a package."""
    field_types = {field.type for each in definitions for part in each.parts for field in part}
    if ros == 1:
        field_types -= set(_ROS_1_TIMES)
    else:
        field_types = {_ROS_2_TIMES.get(each, each) for each in field_types}
    return sorted({each.partition("/")[0] for each in field_types if "/" in each} - {package})


def _record_field(field: InterfaceField, package: str, ros: int) -> dict[str, object]:
    spellings = {1: _spell_in_ros_1(field, package), 2: _spell_in_ros_2(field, package)}
    remarks = [field.comment] if field.comment else []
    if ros == 1:
        # What ROS 1 cannot say is said to people.
        remarks += [f"at most {bound} characters" for bound in _BOUND.findall(field.type)]
        remarks += [f"at most {bound} of them" for bound in _BOUND.findall(field.array)]
        remarks += [f"{field.default} unless set"] if field.default else []
    return {
        "name": field.name,
        "ros_type": field.type,
        "array": field.array,
        "spelling": spellings[ros],
        "ros_1_spelling": spellings[1],
        "ros_2_spelling": spellings[2],
        "default": field.default if ros == 2 else "",  # noqa: PLR2004 - the generation of ROS
        "comment": "; ".join(remarks),
    }


def _spell_in_ros_2(field: InterfaceField, package: str) -> str:
    return f"{_shorten_message(_ROS_2_TIMES.get(field.type, field.type), package)}{field.array}"


def _spell_in_ros_1(field: InterfaceField, package: str) -> str:
    base_type = _ROS_1_TIMES.get(field.type) or _shorten_message(_BOUND.sub("", field.type), package)
    return f"{base_type}{'[]' if _BOUND.search(field.array) else field.array}"


def _shorten_message(message: str, package: str) -> str:
    """Return a message as files name it: one of the same package by its name alone."""
    if "/" not in message:
        return message
    other_package, _, name = message.split("/")
    return name if other_package == package else f"{other_package}/{name}"


def _record_constant(constant: InterfaceConstant, ros: int) -> dict[str, object]:
    return {
        "name": constant.name,
        "type": constant.type,
        # In ROS 1 the text of a constant is the rest of its line, comments and quotes included.
        "value": _unquote(constant.value) if ros == 1 and constant.type == "string" else constant.value,
        "comment": "" if ros == 1 and constant.type == "string" else constant.comment,
        "remark": constant.comment if ros == 1 and constant.type == "string" else "",
    }


def _unquote(value: str) -> str:
    is_quoted = len(value) > 1 and value[0] in _QUOTES and value[-1] == value[0]
    return value[1:-1].replace(f"\\{value[0]}", value[0]) if is_quoted else value
