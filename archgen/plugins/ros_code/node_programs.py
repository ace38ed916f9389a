"""The views `programs` and `ros1_programs`: the packages of ROS nodes to generate, and each program in them with all that it has.

Which callbacks of a generated program exclude one another: its callback groups. Which programs can be generated at all:
their packages and executables are names of folders, files and modules.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from archgen.plugin import replace
from archgen.plugin.findings import NO_SPAN, Diagnostic, Label, Severity, Span, first_written_span
from archgen.plugin.generating import (
    NOT_GENERATED,
    PORT_SECTIONS,
    GeneratedView,
    GenerationContext,
    ProgramNames,
    find_endpoint_span,
    find_name_clashes,
    find_node_language,
    find_program_type,
    group_by_program,
    index_endpoints,
    is_loadable,
    list_generated_nodes,
    list_node_values,
    make_camel_name,
    make_identifier_in,
    make_ros_name,
    make_snake_name,
    name_package,
    record_parameters,
    record_ports,
    tell_left_out,
    title_from_id,
    write_place,
)
from archgen.plugin.model import Architecture, ConceptualType, Endpoint, Node
from archgen.plugin.ros import is_ros_1
from archgen.plugins.ros_code.cpp_programs import (
    complete_cpp_program,
    find_bad_classes,
    list_cpp_libraries,
)
from archgen.plugins.ros_code.interface_packages import find_refused_messages, tell_unlisted_packages
from archgen.plugins.ros_code.package_facts import RosdepKeys, record_package_facts
from archgen.plugins.ros_code.program_differences import find_program_differences, list_timers


def make_ros1_view(context: GenerationContext) -> GeneratedView:
    """Return the programs to generate for ROS 1."""
    return make_view(context, ros=1)


def make_view(context: GenerationContext, ros: int = 2) -> GeneratedView:
    """Return the programs to generate for a generation of ROS: `packages`, and all their `programs`.

    Nodes that exist (`status: existing` or `adapted`) have a program already, and what is no node of ROS has none here. The option
    `language` says whose programs are made, `python` or `cpp`; nodes that say none are generated in `python`.
    With the option `with_cpp` there is also what code in C++ asks for.
    """
    if is_ros_1(context.architecture.distro) != (ros == 1):
        return GeneratedView({"packages": [], "programs": []}, (_tell_other_ros(ros),))
    language = str(context.options.get("language") or "python")
    is_cpp = bool(context.options.get("with_cpp"))
    all_programs = _find_programs(context, language)
    program_names = ProgramNames(context.architecture, ros)
    findings: list[Diagnostic] = [
        *_find_mixed_packages(context, all_programs, language),
        *_tell_nothing(context, all_programs, language),
    ]
    programs, unusable = drop_unusable(all_programs, language)
    findings += unusable
    refused_messages = find_refused_messages(context.architecture, ros)
    endpoints = index_endpoints(context.architecture)
    for node in (node for nodes in programs.values() for node in nodes):
        findings += _tell_refused(context.architecture, endpoints.get(node.id, ()), refused_messages)
    packages: dict[str, dict[str, Any]] = {}
    records: list[dict[str, object]] = []
    names: dict[str, list[tuple[str, str, Span]]] = {}
    for (package_name, program_name), program_nodes in sorted(programs.items()):
        if is_cpp:
            bad_classes = find_bad_classes(
                package_name, program_name, program_nodes, _find_place(context.architecture, program_nodes[0])
            )
            findings += bad_classes
            if bad_classes:
                continue
        record, program_findings = _record_program(
            context, (package_name, program_name), program_nodes, program_names, refused_messages
        )
        if is_cpp:
            complete_cpp_program(context.architecture, record, program_nodes)
        first = program_nodes[0]
        names.setdefault(package_name, []).append((str(record["class_name"]), first.id, first.at))
        records.append(record)
        findings += program_findings
        findings += find_program_differences(program_name, program_nodes, endpoints)
        if package_name not in packages:
            packages[package_name] = {
                **record_package_facts(context, first.owner),
                "name": package_name,
                "language": language,
                "programs": [],
                "place": write_place(_find_place(context.architecture, first)),
            }
        packages[package_name]["programs"].append(record)
    used_packages = {name for each in records for name in each["message_packages"]}  # type: ignore[attr-defined]
    findings += tell_unlisted_packages(context.architecture, used_packages)
    keys = RosdepKeys(context.architecture)
    findings += keys.findings
    for package in packages.values():
        _complete_package(context, package, keys, is_cpp=is_cpp)
    for in_package in names.values():
        findings += find_name_clashes(in_package, "class")
    return GeneratedView({"packages": list(packages.values()), "programs": records}, tuple(findings))


def _complete_package(context: GenerationContext, package: dict[str, Any], keys: RosdepKeys, *, is_cpp: bool) -> None:
    """Tell a package what its programs need."""
    programs = package["programs"]
    used = {name for each in programs for name in each["message_packages"]}
    package["dependencies"] = sorted(used)
    package["rosdep_keys"] = keys.list_keys(used)
    if is_cpp:
        of_messages = set(_MESSAGE_LIBRARIES) - used if context.options.get("stand_ins") else ()
        package["libraries"] = list_cpp_libraries(programs, of_messages)
    package["has_actions"] = any(each["action_servers"] or each["action_clients"] for each in programs)


def _tell_other_ros(ros: int) -> Diagnostic:
    return tell_left_out(
        f"the project is made for ROS {3 - ros}: it has no nodes for ROS {ros}",
        NO_SPAN,
        help_line="generate with another backend, or write another `distro` below `ros`",
    )


def _tell_nothing(context: GenerationContext, programs: Collection[object], language: str) -> Iterator[Diagnostic]:
    """Say why no program is made, where none is though everything is asked for."""
    if programs or not context.is_whole:
        return
    if not list_generated_nodes(context.architecture):
        message = "there is no node to generate: each exists already, or is no node of ROS"
        help_line = "`status: planned` says of a node that it does not exist yet"
    else:
        name, other_name = ("C++", "Python") if language == "cpp" else ("Python", "C++")
        message = f"no node is in {name}: all that are to be generated are in {other_name}"
        help_line = f"write `language: {language}` at nodes that are to be in {name}"
    yield replace(tell_left_out(message, NO_SPAN, help_line=help_line), severity=Severity.NOTE)


def _name_module(program_name: str) -> str:
    """Return the module of a program: `planner` of the program `planner_node`, since its node stands in `planner_node.py`."""
    return make_identifier_in("python", make_snake_name(make_snake_name(program_name).removesuffix("_node")))


def _find_programs(context: GenerationContext, language: str) -> dict[tuple[str, str], list[Node]]:
    """Return the nodes of each program that is asked for. One node is enough for all of its package, which is made whole."""
    nodes = [each for each in list_generated_nodes(context.architecture) if find_node_language(each) == language]
    programs = group_by_program(context.architecture, nodes)
    packages = {
        package
        for (package, _), program_nodes in programs.items()
        if any(each.id in context.wanted_nodes for each in program_nodes)
    }
    return {names: program_nodes for names, program_nodes in programs.items() if names[0] in packages}


def _find_mixed_packages(
    context: GenerationContext, programs: Mapping[tuple[str, str], Sequence[Node]], language: str
) -> Iterator[Diagnostic]:
    """Yield packages that hold programs of both languages: one build cannot make both."""
    other_language = "cpp" if language == "python" else "python"
    others = {
        name_package(context.architecture, node): node
        for node in list_generated_nodes(context.architecture)
        if find_node_language(node) == other_language
    }
    told = set[str]()
    for (package_name, _), nodes in programs.items():
        if package_name in others and package_name not in told:
            told.add(package_name)
            yield tell_left_out(
                f"the package `{package_name}` has programs in Python and in C++: `{nodes[0].id}` and "
                f"`{others[package_name].id}`; here it has only those in {'Python' if language == 'python' else 'C++'}",
                nodes[0].at,
                element=nodes[0].id,
                help_line="give the nodes of one language a `package` of their own",
            )


def _record_program(
    context: GenerationContext,
    package_and_program: tuple[str, str],
    nodes: Sequence[Node],
    program_names: ProgramNames,
    refused_messages: Collection[str],
) -> tuple[dict[str, object], list[Diagnostic]]:
    architecture, first = context.architecture, nodes[0]
    package_name, program_name = package_and_program
    components = [architecture.components[each] for each in sorted(first.implements)]
    sections, findings = record_ports(architecture, nodes, program_names.find_ports(nodes), refused_messages)
    timers = list(list_timers(first))
    parameters, parameter_findings = record_parameters(architecture, nodes)
    message_packages = {str(port["package"]) for ports in sections.values() for port in ports}
    component_type = find_program_type(architecture, nodes)
    functionalities = [each.functionality for each in components if each.functionality]
    title = components[0].title if len(components) == 1 else first.title
    description = first.description or " ".join(functionalities)
    place = write_place(_find_place(architecture, first))
    if component_type:
        title, place = component_type.title, write_place(component_type.at)
    elif len(nodes) > 1:
        # What holds of the first of its nodes alone is not said of the program.
        title, description, place = title_from_id(program_name), "", program_name
    module = _name_module(program_name)
    class_name = make_camel_name(module)
    if {class_name, f"{class_name}Node"} & IMPORTED_CLASSES:
        class_name += "Program"
    import_messages = import_in_ros_1 if is_ros_1(architecture.distro) else import_in_ros_2
    record: dict[str, object] = {
        "package": package_name,
        "executable": program_name,
        "module": module,
        "class_name": class_name,
        "component_type": component_type.id if component_type else "",
        "title": title,
        "description": description,
        "is_lifecycle": "lifecycle" in first.kinds,
        "is_composable": is_loadable(first),
        "nodes": [_record_node(architecture, each, program_names) for each in nodes],
        "node_name": make_ros_name(program_name),
        "threads": first.threads,
        "reentrant": first.reentrant,
        "timers": timers,
        "callback_groups": add_callback_groups(first, sections, timers),
        "parameters": parameters,
        **sections,
        "message_packages": sorted(message_packages),
        "fields": list_message_fields(
            architecture, {str(port["type"]) for ports in sections.values() for port in ports}
        ),
        "python_imports": import_messages(sections, class_name),
        "place": place,
    }
    _say_when_sent(sections, timers)
    if component_type or len(nodes) > 1:
        # Of a type or program, not of the first of its nodes.
        for timer in timers:
            timer["component"] = component_type.id if component_type else program_name
    return record, [*findings, *parameter_findings]


def _say_when_sent(sections: Mapping[str, Sequence[dict[str, object]]], timers: Iterable[Mapping[str, object]]) -> None:
    """Tell each publisher in which method a stand-in sends: on its component's timer, else with what that hears first."""
    methods: dict[str, str] = {}
    for port in sections["subscriptions"]:
        methods.setdefault(str(port["port"]).rpartition(".")[0], f"receive_{port['key']}")
    methods |= {str(each["component"]): f"on_timer_{each['key']}".rstrip("_") for each in timers}
    for port in sections["publishers"]:
        port["sent_in"] = methods.get(str(port["port"]).rpartition(".")[0], "send_seldom").rstrip("_")


def _tell_refused(
    architecture: Architecture, endpoints: Iterable[Endpoint], refused_messages: Collection[str]
) -> Iterator[Diagnostic]:
    """Yield what is left out of a node since no package can have its message."""
    for each in endpoints:
        if each.message in refused_messages:
            yield tell_left_out(
                f"`{each.port or each.label}` of the node `{each.node}` is left out: `ros_interfaces` generates no "
                f"`{each.message}`, and says why",
                find_endpoint_span(architecture, each),
                element=each.node,
            )


def _record_node(architecture: Architecture, node: Node, program_names: ProgramNames) -> dict[str, object]:
    return {
        "id": node.id,
        "name": node.name,
        "namespace": node.namespace,
        "full_name": node.full_name,
        "implements": sorted(node.implements),
        "parameters": list_node_values(architecture, node),
        "remaps": [{"own_name": own_name, "name": name} for own_name, name in program_names.find_remaps(node).items()],
        "place": write_place(_find_place(architecture, node)),
    }


def _find_place(architecture: Architecture, node: Node) -> Span:
    """Return where a node is written; of one that archgen adds, its component."""
    components = (architecture.components[each] for each in node.implements)
    return first_written_span(node.at, *(each.at for each in components))


_PACKAGE = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z", re.ASCII)
_EXECUTABLE = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*\Z", re.ASCII)
_MAX_NAME = 100
_MESSAGE_LIBRARIES = (
    *("builtin_interfaces", "rosidl_runtime_c", "rosidl_typesupport_cpp", "rosidl_typesupport_introspection_cpp"),
)
"""With which stand-ins in C++ learn what is in a message."""
_LANGUAGES = {"python": "Python", "cpp": "C++"}


def drop_unusable(
    programs: Mapping[tuple[str, str], Sequence[Node]], language: str
) -> tuple[dict[tuple[str, str], Sequence[Node]], list[Diagnostic]]:
    """Return the programs, by package and executable, whose names can be written, and a finding for each name that cannot."""
    usable: dict[tuple[str, str], Sequence[Node]] = {}
    findings: dict[tuple[str, ...], Diagnostic] = {}
    first_packages: dict[str, tuple[str, Node]] = {}
    # Of two names that are one folder the usual one stays, whatever the order of lines.
    for (package, executable), nodes in sorted(programs.items(), key=lambda each: (not each[0][0].islower(), each[0])):
        node = nodes[0]
        twin, twin_node = first_packages.setdefault(package.casefold(), (package, node))
        fault = _explain_bad_package(package, language)
        if fault:
            findings.setdefault((package,), _diagnose_program(f"the package `{package}` is left out: {fault}", node))
        elif twin != package:
            message = f"the package `{package}` is left out: on many systems it is the folder of `{twin}`"
            findings.setdefault((package,), _diagnose_program(message, node, twin_node))
        elif len(executable) > _MAX_NAME or not _EXECUTABLE.match(executable):
            message = f"the program `{executable}` of `{node.id}` is left out: no file is called so that ROS runs"
            findings[package, executable] = _diagnose_program(message, node)
        else:
            usable[package, executable] = nodes
    return usable, list(findings.values())


def _explain_bad_package(package: str, language: str) -> str:
    """Return why a package cannot have a name, as the end of a sentence; empty where it can."""
    if not _PACKAGE.match(package):
        return "packages have names of letters (a to z), digits and `_`"
    if len(package) > _MAX_NAME:
        return f"its name has more than {_MAX_NAME} letters"
    if make_identifier_in(language, package) == f"{package}_":
        return f"its name is a word of {_LANGUAGES[language]}"
    return ""


def _diagnose_program(message: str, node: Node, first: Node | None = None) -> Diagnostic:
    labels = (Label(first.at, "the first one"),) if first else ()
    help_line = "give the node another `package` or `executable`"
    severity = NOT_GENERATED.severity
    return Diagnostic(NOT_GENERATED.name, message, node.at, severity, labels=labels, help=help_line, element=node.id)


CALLED_SECTIONS = ("subscriptions", "services", "clients", "action_servers", "action_clients")
"""What has callbacks beside timers."""


def add_callback_groups(
    node: Node, sections: Mapping[str, Sequence[dict[str, object]]], timers: Iterable[dict[str, object]]
) -> list[dict[str, object]]:
    """Tell each port and timer its `callback_group`, and return the groups: `key`, and the components in it.

    A key is a name that something is written behind, in any language: `fast` of `fast_lock`. What is in none is in the node's default group. Where all is reentrant, there are none.
    """
    groups = {} if node.reentrant else _name_groups(node)
    key_by_component = {component: key for key, members in groups.items() for component in members}
    used_keys = set[str]()
    for section in CALLED_SECTIONS:
        for port in sections[section]:
            key = key_by_component.get(str(port["port"]).rpartition(".")[0], "")
            port["callback_group"] = key
            used_keys.add(key)
    for timer in timers:
        key = key_by_component.get(str(timer["component"]), "")
        timer["callback_group"] = key
        used_keys.add(key)
    return [{"key": key, "components": list(members)} for key, members in groups.items() if key in used_keys]


def _name_groups(node: Node) -> dict[str, tuple[str, ...]]:
    """Return the components of each group, by a name of its own."""
    named: dict[str, tuple[str, ...]] = {}
    for group, members in node.callback_groups.items():
        stem = make_snake_name(group)
        key, number = stem, 1
        while key in named:
            number += 1
            key = f"{stem}_{number}"
        named[key] = members
    return named


_PARTS: Mapping[str, Mapping[str, str]] = {
    "srv": {"request": "/Request", "response": "/Response"},
    "action": {"request": "/Goal", "response": "/Result", "feedback": "/Feedback"},
}
"""The classes of a service's and an action's parts, behind its own."""


def list_message_fields(architecture: Architecture, type_names: Iterable[str]) -> list[dict[str, str]]:
    """Return the fields of types and of what is in them: each with its message in front, and with the message that it is, if any."""
    fields: dict[str, str] = {}
    waiting, seen = sorted(type_names), set[str]()
    while waiting:
        type_name = waiting.pop()
        data_type = architecture.types.get(type_name)
        if data_type is None or type_name in seen or not data_type.message:
            continue
        seen.add(type_name)
        for class_name, name, inner_name in _list_fields(data_type, data_type.message):
            inner = architecture.types.get(inner_name)
            fields[f"{class_name}.{name}"] = (inner.message if inner else None) or ""
            waiting.append(inner_name)
    return [{"name": name, "message": message} for name, message in sorted(fields.items())]


def _list_fields(data_type: ConceptualType, message: str) -> Iterator[tuple[str, str, str]]:
    """Yield each field of a type: its class, its name, and its type, without what makes a list of it."""
    parts = _PARTS.get(message.split("/")[1], {})
    for part, each in data_type.list_fields():
        yield f"{message}{parts.get(part, '')}", each.name, (each.type or "").partition("[")[0]


_IMPORTED_OF_ROS_2 = frozenset(
    [
        *("ActionClient", "ActionServer", "Clock", "ClockType", "Duration", "DurabilityPolicy"),
        *("ExternalShutdownException", "FloatingPointRange", "Future", "GoalResponse", "HistoryPolicy", "IntegerRange"),
        *("LifecycleNode", "LivelinessPolicy", "MultiThreadedExecutor", "MutuallyExclusiveCallbackGroup", "Node"),
        *("NotActive", "Parameter", "ParameterDescriptor", "QoSProfile", "ReentrantCallbackGroup", "ReliabilityPolicy"),
        *("SetParametersResult", "TransitionCallbackReturn"),
    ]
)
"""What the modules of nodes import of rclpy: a message of this name is imported under another one."""
_IMPORTED_OF_ROS_1 = frozenset(["RLock", "SimpleActionClient", "SimpleActionServer"])
"""The same of rospy, actionlib and Python."""
IMPORTED_CLASSES = _IMPORTED_OF_ROS_2 | _IMPORTED_OF_ROS_1
"""What no class of a program is called: it would hide what its module imports."""
_ROS_1_CLASSES: Mapping[str, Sequence[str]] = {
    "services": ("", "Response"),
    "action_servers": ("Action",),
    "action_clients": ("Action",),
}
"""How the classes end that are imported for a port in ROS 1; of a topic it is the message alone."""
_Sections = Mapping[str, Sequence[dict[str, object]]]


def import_in_ros_2(sections: _Sections, class_name: str) -> list[dict[str, object]]:
    """Return what is imported of which module, and tell each port the class of its message (`python_class`).

    Messages of one name in several packages are told apart by their packages.
    """

    def list_classes(_section: str, port: Mapping[str, object]) -> tuple[str, list[str]]:
        return f"{port['package']}.{port['kind']}", [str(port["name"])]

    return _import_classes(
        sections, list_classes, {class_name, f"{class_name}Node", f"{class_name}StandIn", *_IMPORTED_OF_ROS_2}
    )


def import_in_ros_1(sections: _Sections, class_name: str) -> list[dict[str, object]]:
    """Return the same for ROS 1.

    There the response of a service is a class of its own (`part_class`), and an action is a message.
    """

    def list_classes(section: str, port: Mapping[str, object]) -> tuple[str, list[str]]:
        module = "srv" if port["kind"] == "srv" else "msg"
        return f"{port['package']}.{module}", [f"{port['name']}{end}" for end in _ROS_1_CLASSES.get(section, ("",))]

    return _import_classes(sections, list_classes, {class_name, f"{class_name}Node", *_IMPORTED_OF_ROS_1})


def _import_classes(
    sections: _Sections,
    list_classes: Callable[[str, Mapping[str, object]], tuple[str, list[str]]],
    taken_names: Collection[str],
) -> list[dict[str, object]]:
    listed = [(port, *list_classes(section, port)) for section in PORT_SECTIONS.values() for port in sections[section]]
    modules_by_name: dict[str, set[str]] = {}
    for _, module, names in listed:
        for name in names:
            modules_by_name.setdefault(name, set()).add(module)
    imports: dict[str, set[str]] = {}
    for port, module, names in listed:
        classes = []
        for name in names:
            is_taken = len(modules_by_name[name]) > 1 or name in taken_names
            classes.append(f"{make_camel_name(module)}{name}" if is_taken else name)
            imports.setdefault(module, set()).add(f"{name} as {classes[-1]}" if is_taken else name)
        port["python_class"], port["part_class"] = classes[0], classes[-1]
    return [{"module": module, "names": sorted(each)} for module, each in sorted(imports.items())]
