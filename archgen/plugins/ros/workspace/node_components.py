"""A launched node as a component with ports, and as a node that says what its program calls each of them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from archgen.plugin.importing import (
    FlowMapping,
    MappingNode,
    ScalarNode,
    YamlNode,
    load_shipped_component_types,
    make_id,
    make_unique_id,
    node_to_data,
)
from archgen.plugin.ros import find_name_fault, find_node_name_fault
from archgen.plugins.ros.launch.launch_entities import LaunchedNode
from archgen.plugins.ros.launch.launch_import import find_stem, nest_parameters
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.sources.walk_values import (
    FoundEndpoint,
    FoundNode,
    JoinedText,
    ParameterValue,
    UnknownText,
    find_unknown,
    find_unknown_place,
    settle,
    show_value,
)
from archgen.plugins.ros.workspace.program_reading import ReadProgram, flatten_parameters

LIBRARY = "ros"
"""What a project calls the library that ships."""
_SHARED = frozenset({"/tf", "/tf_static", "/clock", "/diagnostics", "/rosout", "/parameter_events"})
_POOR_WORDS = frozenset(
    {"pose", "state", "global", "local", "data", "raw", "status", "image", "command", "cmd", "info"}
)
_MANAGER = "lifecycle_manager"
_MANAGER_PARAMETERS = ("node_names", "autostart")
"""By these a manager of Nav2 says whom it activates."""
_STAMP_PARAMETERS = ("enable_stamped_cmd_vel", "use_stamped")
"""By these programs of Nav2 and twist_mux say whether their velocities have a time."""
_VELOCITIES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_NO_VARIANT = "base"
"""What the project itself is called, where variants are named."""
_USUAL_QOS = {"depth": 10}
"""What ROS takes where nothing else is said."""
_HINT = "launch"
_KEPT_HINTS = ("conditions", "by_default", "other_ways")
_CONDITION_SIGNS = frozenset({"var", "arg", "eval", "env", "if"})


@dataclass(frozen=True, slots=True)
class NodeKnowledge:
    """A launched node with what is known of it: by its sources, or as a type of the library."""

    node: LaunchedNode
    program: ReadProgram | None
    library_type: str
    launch_files: tuple[str, ...] = ()
    """Which of several launch files start it, where some do not."""
    manager: str = ""
    """The name of the controller manager in whose process it runs."""

    @property
    def is_nameless(self) -> bool:
        """Whether nobody says what the node is called: neither who launches it, nor its sources, nor a type of the library."""
        is_told = self.program is not None or self.library_type or self.node.known_name
        return not is_told and self.node.form in {"node", "loaded"}


@dataclass(slots=True, eq=False)
class WrittenNode:
    """A node of the language and its component, which is called alike. Comments go by their paths below the component."""

    id: str
    group: str
    data: dict[str, Any]
    component: dict[str, Any]
    package: str
    """That of its program."""
    variants: Mapping[str, str] = field(default_factory=dict)
    """By their names the titles of the variants in which it runs; none for what always runs."""
    comments: dict[tuple[str, ...], str] = field(default_factory=dict)
    known: NodeKnowledge | None = None
    found: FoundNode | None = None
    """What its program makes of it, where its sources were read."""
    endpoints: dict[tuple[str, str], FoundEndpoint] = field(default_factory=dict)
    """What its sources say of each port, by use and port."""


def _list_variants(known: NodeKnowledge) -> dict[str, str]:
    """Return the variants in which a node runs that the defaults do not start, or only one of several launch files."""
    if known.node.is_on:
        return {_name_variant(find_stem(Path(file))): f"Launched by {file}" for file in known.launch_files}
    conditions = tuple(dict.fromkeys(known.node.conditions))
    words = re.findall(r"\w+", conditions[-1].replace("unless", "no")) if conditions else []
    words = [word for word in words if word not in _CONDITION_SIGNS]
    return {_name_variant("_".join(words)): f"Launched {' and '.join(conditions)}"} if words else {}


def _name_variant(words: str) -> str:
    name = make_id(words, "variant")
    return name if name != _NO_VARIANT else f"{name}_variant"


class NodeWriter:
    """Writes nodes, with their counts and notes."""

    def __init__(self, account: ImportAccount, distro: str) -> None:
        self._account = account
        self._distro = distro

    def write_node(self, node_id: str, data: Mapping[str, Any], known: NodeKnowledge, group: str) -> list[WrittenNode]:
        """Return a launched node, and others that its program makes; `data` is what the launch file says of it."""
        hints = data.get("hints", {}).get(_HINT, {})
        kept = {_HINT: {key: hints[key] for key in _KEPT_HINTS if key in hints}}
        if known.is_nameless:
            kept[_HINT]["name"] = "unknown"
        body = {key: value for key, value in data.items() if key != "hints"}
        if kept[_HINT]:
            body["hints"] = kept
        self._leave_out_filed(body, known)
        data = {"implements": f"{group}.{node_id}", **body}
        written = WrittenNode(node_id, group, data, {}, known.node.package, _list_variants(known), known=known)
        self._account.count("node")
        if known.manager:
            written.comments[()] = f"in the process of {known.manager}"
        if known.library_type:
            written.component |= {"is": f"{LIBRARY}.{known.library_type}", **self._choose_stamps(known)}
            self._account.count("node of the library")
            self._note_other_topics(known)
        if known.program is None:
            if not known.library_type and known.node.form != "program":
                unknown = "its name, and what it says to ROS, are" if known.is_nameless else "what it says to ROS is"
                words = f"{unknown} not known: no sources, no type of the library"
                written.comments[()] = "; ".join(filter(None, [written.comments.get(()), words]))
                self._account.count("node without sources")
            return [written]
        self._account.count("node with sources")
        first, *others = known.program.nodes
        self._write_found(written, first, known, is_first=True)
        return [written, *(self._write_other(written, found, known) for found in others)]

    def _choose_stamps(self, known: NodeKnowledge) -> dict[str, Any]:
        """Return the ports of a library type whose velocities have a time, or none, by a parameter: their messages."""
        given = flatten_parameters(known.node.parameters)
        stamped = next((given[name] for name in _STAMP_PARAMETERS if isinstance(given.get(name), bool)), None)
        changed: dict[str, Any] = {}
        if stamped is None:
            return changed
        facts: Any = node_to_data(load_shipped_component_types(self._distro)[known.library_type].value)
        for side in ("inputs", "outputs"):
            for port, body in facts.get(side, {}).items():
                message = body.get("type") if isinstance(body, Mapping) else body
                if message == _VELOCITIES[not stamped]:
                    typed = _VELOCITIES[stamped]
                    ports = changed.setdefault(side, FlowMapping())
                    ports[port] = typed if side == "outputs" else FlowMapping({"type": typed})
        return changed

    def _write_other(self, first: WrittenNode, found: FoundNode, known: NodeKnowledge) -> WrittenNode:
        """Return another node of the same process: what starts the first one counts for it, too."""
        node_id = make_id(show_value(found.name).replace("*", "node"), "node")
        node_id = node_id if node_id != first.id else f"{node_id}_2"
        shared = ("namespace", "status", "remaps", "arguments", "parameters")
        data: dict[str, Any] = {key: first.data[key] for key in ("implements", *shared) if key in first.data}
        data["implements"] = f"{first.group}.{node_id}"
        written = WrittenNode(node_id, first.group, data, {}, first.package, first.variants, known=known)
        written.comments[()] = f"in the process of {first.id}"
        self._account.count("node")
        self._write_found(written, found, known, is_first=False)
        return written

    def _leave_out_filed(self, data: dict[str, Any], known: NodeKnowledge) -> None:
        """Leave out the parameters that stand in a file that the node reads, but those that name topics, or nodes to activate."""
        if known.program is not None and known.program.is_ros_1:
            return
        kept = _list_naming_parameters(known.library_type, self._distro) if known.library_type else []
        kept += _MANAGER_PARAMETERS if _MANAGER in known.node.executable else ()
        for found in known.program.nodes if known.program else ():
            kept += [re.escape(each.name.name) for each in found.endpoints if isinstance(each.name, ParameterValue)]
        naming = re.compile("|".join(kept) or "(?!)")
        left_out = {name for name in known.node.file_parameters if not naming.fullmatch(name)}
        if left_out:
            data.pop("parameters", None)
            parameters = nest_parameters({k: v for k, v in known.node.parameters.items() if k not in left_out})
            if parameters:
                data["parameters"] = parameters

    def _note_other_topics(self, known: NodeKnowledge) -> None:
        """Say which topics are named to a type of the library as it is told of its own (`topics.X.topic`), and are none of these."""
        if known.program is not None:
            return
        namings = _list_namings(known.library_type, self._distro)
        endings = {name.rpartition(".")[2] for name in namings if "." in name and not re.search(r"[*{]", name)}
        naming = re.compile("|".join(_list_naming_parameters(known.library_type, self._distro)) or "(?!)")
        for name, value in flatten_parameters(known.node.parameters).items():
            is_named = isinstance(value, str) and "." in name and name.rpartition(".")[2] in endings
            if is_named and not naming.fullmatch(name):
                self._account.add_note(
                    "topic",
                    f"`{value}` (parameter `{name}` of `{known.node.known_name}`): `{LIBRARY}.{known.library_type}` has no port for it",
                    known.node.span,
                    f"make a component type from it (`is: {LIBRARY}.{known.library_type}`) with one more input, and in its"
                    f" `node` `subscribes: {{INPUT: {{named_by: {name}}}}}`",
                )

    def _write_found(self, written: WrittenNode, found: FoundNode, known: NodeKnowledge, *, is_first: bool) -> None:
        data, name, namespace = written.data, settle(found.name), settle(found.namespace)
        _open_below_base(written, known.program)
        written.found = found
        if (not is_first or not known.node.name) and isinstance(name, str) and not find_node_name_fault(name):
            data.pop("name", None)
            if name != written.id:
                data["name"] = name
        if (
            not known.node.namespace
            and isinstance(namespace, str)
            and namespace.strip("/")
            and not find_name_fault(namespace)
        ):
            data["namespace"] = f"/{namespace.strip('/')}"
        if found.is_lifecycle and is_first:
            data.setdefault("kind", "lifecycle")
        for endpoint in found.endpoints:
            if _is_unclear(show_value(endpoint.name), known.node.unclear_remaps):
                endpoint.name = UnknownText(f"a computed remap of {show_value(endpoint.name)}", known.node.span)
            elif isinstance(namespace, UnknownText) and not show_value(endpoint.name).startswith("/"):
                endpoint.name = JoinedText((namespace, "/", endpoint.name))
            self._write_endpoint(written, endpoint, is_ros_1=known.program is not None and known.program.is_ros_1)
        named_by = {
            each.name.name: name
            for each in found.endpoints
            if isinstance(each.name, ParameterValue) and each.name.name and each.name.value is not each.name.default
            if not isinstance(name := settle(each.name), UnknownText)
        }
        if named_by and not (known.program is not None and known.program.is_ros_1):
            # What names its topics may stand in a file, below a name that only the program knows.
            data["parameters"] = nest_parameters({**named_by, **flatten_parameters(data.get("parameters", {}))})
        if len(found.periods) == 1 and found.periods[0] and not {"subscribes", "serves"} & set(data):
            data["timing"] = {**data.get("timing", {}), "period": f"{found.periods[0] * 1000:.6g} ms"}

    def _write_endpoint(self, written: WrittenNode, endpoint: FoundEndpoint, *, is_ros_1: bool) -> None:
        name = settle(endpoint.name)
        if name is None or name == "":
            # An empty name, by a parameter: such a node makes none.
            return
        text = name if isinstance(name, str) and not find_name_fault(name, ros_1=is_ros_1) else ""
        self._account.count("endpoint")
        typed = endpoint.message or None
        if text in _SHARED and endpoint.flow == "topic":
            internal = written.data.setdefault("internal", FlowMapping()).setdefault(endpoint.use, FlowMapping())
            port = make_id(text, "topic")
            internal[port] = FlowMapping({"topic": text, **({"message": typed} if typed else {})})
            written.endpoints[endpoint.use, port] = endpoint
            return
        side = "outputs" if endpoint.use in {"publishes", "serves"} else "inputs"
        ports = written.component.setdefault(side, FlowMapping())
        port = _name_port(text or show_value(endpoint.name).replace("*", "_"), endpoint, ports)
        ports[port] = typed if side == "outputs" else FlowMapping({"type": typed})
        written.endpoints[endpoint.use, port] = endpoint
        written.data.setdefault(endpoint.use, FlowMapping())[port] = _write_use(
            text, endpoint, written.data, is_ros_1=is_ros_1
        )
        place = f"{endpoint.span.file}:{endpoint.span.line}"
        if endpoint.is_conditional and text:
            written.comments[side, port] = f"made under a condition, {place}"
        elif not text:
            shown = show_value(endpoint.name)
            expression, at = find_unknown(endpoint.name) or shown, find_unknown_place(endpoint.name) or endpoint.span
            place = f"{at.file}:{at.line}"
            known_part = f"`{shown}`, " if shown.strip("*/") else ""
            written.comments[side, port] = f"name unknown: {known_part}`{expression[:60]}`, {place}"
            words = f"the name of what it {endpoint.use} is computed: {known_part}`{expression}`"
            self._account.add_note("name", words, at, fate="noted")
            self._account.count("endpoint without a name")


def _open_below_base(written: WrittenNode, program: ReadProgram | None) -> None:
    """Say that there may be more of a node whose class has a base that nobody read."""
    if program is not None and program.strange_base:
        written.component["open"] = ["*"]
        written.comments["open",] = f"its base `{program.strange_base[:80]}` lies elsewhere, and may use more"


def _is_unclear(name: str, unclear_remaps: set[str]) -> bool:
    """Whether a computed remap may give a name another one, however it is spelled."""
    last = name.rpartition("/")[2]
    return any(own_name == "*" or own_name.rpartition("/")[2].strip("~") == last for own_name in unclear_remaps)


def _write_use(text: str, endpoint: FoundEndpoint, data: Mapping[str, Any], *, is_ros_1: bool) -> Any:  # noqa: ANN401 - a name, or more
    """Return what a node says of a port: its name in the program, the parameter that gives it, its quality of service."""
    words = [str(word) for word in (*data.get("remaps", ()), *data.get("arguments", ()))]
    last = text.rpartition("/")[2]
    # Where a rule for names may count, it is said that this is the program's own one.
    may_move = any(":=" in word or word.rpartition("/")[2].strip("~") == last for word in words)
    key = "own_name" if may_move else "topic" if endpoint.flow == "topic" else "name"
    use: dict[str, Any] = FlowMapping({key: text} if text else {})
    given = endpoint.name
    if text and isinstance(given, ParameterValue) and given.name and given.value is not given.default:
        default = settle(given.default)
        is_name = isinstance(default, str) and default and not find_name_fault(default, ros_1=is_ros_1)
        use = FlowMapping({**({"own_name": default} if is_name else {}), "named_by": given.name})
    qos = {policy: value for policy, value in endpoint.qos.items() if value is not None}
    if qos not in ({}, _USUAL_QOS) and endpoint.flow == "topic":
        use["qos"] = qos["profile"] if list(qos) == ["profile"] else qos
    return text if list(use) == [key] and not may_move else use


def _name_port(name: str, endpoint: FoundEndpoint, taken: Mapping[str, Any]) -> str:
    """Return a port's id: the last word of its topic, two words where one is poor or taken."""
    words = [word for word in name.replace("~", "").split("/") if word.strip("_")]
    short = make_id(words[-1] if words else endpoint.message.rpartition("/")[2] or endpoint.flow, "port")
    if len(words) > 1 and (short in _POOR_WORDS or short in taken):
        short = make_id("_".join(words[-2:]), "port")
    return make_unique_id(short, taken.keys())


def _list_naming_parameters(library_type: str, distro: str) -> list[str]:
    """Return the parameters by which a type of the library is told what its topics are called, as regular expressions."""
    found: list[str] = []
    for text in _list_namings(library_type, distro):
        found += [re.escape(name) for name in re.findall(r"\{(\w+)\}", text)]
        found.append(".+".join(map(re.escape, re.split(r"\{\w+\}|\*", text))))
    for value in _find_values(library_type, distro, "when"):
        found += [re.escape(inner.key) for inner in value] if isinstance(value, MappingNode) else []
    return found


def _list_namings(library_type: str, distro: str) -> list[str]:
    return [each.text for each in _find_values(library_type, distro, "named_by") if isinstance(each, ScalarNode)]


def _find_values(library_type: str, distro: str, key: str) -> Iterator[YamlNode]:
    """Yield what a type of the library says below a key, at any depth."""
    pending: list[YamlNode] = [load_shipped_component_types(distro)[library_type].value]
    while pending:
        mapping = pending.pop()
        for entry in mapping if isinstance(mapping, MappingNode) else ():
            if entry.key == key:
                yield entry.value
            pending.append(entry.value)
