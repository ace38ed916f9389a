"""What single calls of a program say to ROS: nodes, endpoints, parameters and timers, by the tables of `ros_calls`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.plugin import dataclass, replace
from archgen.plugin.importing import Span
from archgen.plugins.ros.sources import ros_calls
from archgen.plugins.ros.sources.ros_calls import (
    PACKED_IMAGES,
    EndpointCall,
    read_message_name,
    read_qos,
    read_seconds,
    spell_external,
)
from archgen.plugins.ros.sources.source_code import Function, SourceFile
from archgen.plugins.ros.sources.walk_values import (
    Alternatives,
    BoundFunction,
    FoundEndpoint,
    FoundNode,
    JoinedText,
    NodeHandle,
    ParameterValue,
    UnknownText,
    Value,
    WalkedObject,
    join_texts,
    settle,
    show_value,
)

_NAME_KEYS = ("topic", "topic_name", "srv_name", "action_name", "name", "service", "ns")
_TYPE_KEYS = ("msg_type", "srv_type", "action_type", "data_class", "service_class", "topic_type", "ActionSpec")
_WRITING_GETTERS = frozenset({"get_parameter", "get_parameter_or", "getParam", "getParamCached", "get", "param"})
_GETTERS = _WRITING_GETTERS | {"get_param", "get_param_cached"}
PARAMETER_HELPERS = frozenset({"declare_parameter_if_not_declared", "declare_or_get_parameter"})
"""Functions of Nav2, which are parameters' declarations and no more."""
_OWN_ARGUMENTS = "the arguments of its options"
_DECLARERS = PARAMETER_HELPERS | {"declare_parameter"}
_PARAMETER_MODULES = frozenset({"rospy", "ros.param"})


@dataclass(frozen=True, slots=True)
class RosCall:
    """A call: what it is called on, what is called, by which name, and with what."""

    whole: Value
    target: Value
    method: str
    arguments: list[Value]
    keywords: Mapping[str, Value]
    types: Sequence[str]
    span: Span

    def get(self, place: int, keys: Sequence[str] = ()) -> Value:
        """Return an argument by its place, else by one of its keywords."""
        if place < len(self.arguments):
            return self.arguments[place]
        return next((self.keywords[key] for key in keys if key in self.keywords), UnknownText("", self.span))


class RosCallReader:
    """Keeps what was found so far. The walk asks it about each call."""

    def __init__(self, given: Mapping[str, Value], *, is_ros_1: bool) -> None:
        self._given = given
        self.node_names: dict[str, str] = {}
        """The name and namespace that the node is started with, where it is given some."""
        self.is_ros_1 = is_ros_1
        self.node_parameters: dict[str, Mapping[str, Value]] = {}
        """What parameter files give to nodes by the names that the program has for them."""
        self.nodes: list[FoundNode] = []
        self.current_node: FoundNode | None = None
        self.conditions = 0
        """How many conditions around the place are not known."""
        self.file: SourceFile | None = None
        self.open_functions: list[Function] = []

    @property
    def is_cpp(self) -> bool:
        """Whether the place is in C++."""
        return self.file is not None and self.file.language == "cpp"

    def expand_callback_type(self, callback: BoundFunction) -> str:
        """Return the type of what a callback takes."""
        raise NotImplementedError

    def make_node(self, span: Span) -> FoundNode:
        """Return a new node; in ROS 1 a process is one, whatever it makes."""
        if self.is_ros_1 and self.nodes:
            return self.nodes[0]
        self.nodes.append(FoundNode(span))
        self.current_node = self.current_node or self.nodes[-1]
        return self.nodes[-1]

    def name_node(
        self, node: FoundNode, arguments: Sequence[Value], keywords: Mapping[str, Value], *, is_cpp: bool
    ) -> None:
        """Keep the name and namespace that a constructor is given."""
        name = arguments[0] if arguments else keywords.get("node_name", keywords.get("name"))
        if isinstance(name, NodeHandle | WalkedObject) or (is_cpp and not arguments):
            return
        node.name = name
        second = arguments[1] if len(arguments) > 1 and is_cpp else keywords.get("namespace")
        node.namespace = second if isinstance(settle(second), str) else None
        # Options with arguments of their own may put it anywhere.
        hidden = [each for each in arguments if isinstance(each, UnknownText) and each.text == _OWN_ARGUMENTS]
        node.namespace = hidden[0] if hidden else node.namespace

    def find_node(self, value: Value) -> FoundNode | None:
        """Return the node that a value is, or speaks through."""
        return value.node if isinstance(value, WalkedObject | NodeHandle) else None

    def _need_node(self, span: Span, *values: Value) -> FoundNode:
        found = next((node for value in values if (node := self.find_node(value)) is not None), None)
        return found or self.current_node or self.make_node(span)

    # Types whose objects speak to ROS by themselves

    def make_external(  # noqa: PLR0911 - a kind of types each
        self, call: RosCall, full_type: str, *, is_member: bool = False
    ) -> Value:
        """Return the object of a type of ROS that is made; NotImplemented for another type, or one that waits for arguments."""
        plain, _, inner = full_type.partition("<")
        dotted, arguments = plain.replace("::", ".").removeprefix("."), call.arguments
        package, _, last = dotted.rpartition(".")
        first = arguments[0] if arguments else None
        node = self.find_node(first)
        if dotted == "ros.NodeHandle":
            outer = first.prefix if isinstance(first, NodeHandle) else ""
            own = call.get(1) if len(arguments) > 1 else "" if first is None or outer or node else first
            return NodeHandle(self._need_node(call.span), _join_prefix(outer, own))
        if dotted in ros_calls.NODE_CLASSES and not is_member:
            handle = NodeHandle(self.make_node(call.span))
            handle.node.is_lifecycle = "ifecycle" in dotted
            self.name_node(handle.node, arguments, call.keywords, is_cpp=self.is_cpp)
            return handle
        if last == "ImageTransport" and arguments:
            prefix = first.prefix if isinstance(first, NodeHandle) else ""
            return NodeHandle(self._need_node(call.span, first), prefix, "image_transport")
        if (dotted == "message_filters.Subscriber" and self.is_cpp) or last == "SubscriberFilter":
            message = (
                read_message_name(inner.partition(",")[0].rstrip(">"), "topic") if inner else ros_calls.IMAGE_TYPES[0]
            )
            if len(arguments) > 1:
                self._add_filter(call, message)
            return NodeHandle(self._need_node(call.span, first), "", "filter", message)
        is_complete = bool(arguments) or not is_member or package == "tf"
        if last in ros_calls.FIXED_ENDPOINTS and package.partition(".")[0] in ros_calls.FIXED_PACKAGES and is_complete:
            node = self._need_node(call.span, *arguments)
            for use, name, message in ros_calls.FIXED_ENDPOINTS[last]:
                self._add(node, FoundEndpoint(use, "topic", name, message, call.span))
            return NodeHandle(node, "", "fixed")
        if dotted in ros_calls.FUNCTIONS and inner and arguments:
            self._add_call(ros_calls.FUNCTIONS[dotted], call, [inner.removesuffix(">")])
            return UnknownText(last, call.span)
        return NotImplemented

    def _add_filter(self, call: RosCall, message: str) -> None:
        first, *rest = call.arguments
        name = first
        if self.find_node(first) is not None:
            name = _join_prefix(first.prefix, rest[0]) if isinstance(first, NodeHandle) else rest[0]
            rest = rest[1:]
        qos = {} if self.is_ros_1 or not rest else read_qos(rest[0])
        self._add(
            self._need_node(call.span, first), FoundEndpoint("subscribes", "topic", name, message, call.span, qos)
        )

    # Calls

    def read_call(self, call: RosCall) -> Value:  # noqa: C901, PLR0911 - a kind of calls each
        """Return what a call gives, with the place of the argument that it writes into; NotImplemented where it is none of ROS."""
        whole, method, name = call.whole, call.method, spell_external(call.target)
        if isinstance(whole, dict) and (changed := ros_calls.change_qos(whole, method, call.arguments)) is not None:
            return changed
        if isinstance(whole, NodeHandle) and whole.kind:
            return self._read_helper_call(whole, call)
        if name in {"rospy.init_node", "ros.init"}:
            own = call.arguments[2:] if name == "ros.init" else call.arguments
            self.name_node(self._need_node(call.span), own, call.keywords, is_cpp=self.is_cpp)
            return None
        if name in ros_calls.FUNCTIONS:
            return self._add_call(ros_calls.FUNCTIONS[name], call, call.types)
        if name.startswith("image_transport.") and ros_calls.read_image_call(method):
            return self._add_images(
                self._need_node(call.span, *call.arguments[:1]), "", method, call.arguments[1:], call.span
            )
        types = f"<{call.types[0]}>" if call.types else ""
        if name and (made := self.make_external(call, name + types)) is not NotImplemented:
            return made
        if method == "arguments" and call.arguments:
            return UnknownText(_OWN_ARGUMENTS, call.span)
        node = self.find_node(whole)
        if node is not None and method.startswith("get_node_") and method.endswith("_interface"):
            return NodeHandle(node)
        if node is not None and method in {"get_name", "get_namespace"} and not call.arguments:
            word = method.removeprefix("get_")
            return self.node_names.get(word, node.name if word == "name" else node.namespace or "/")
        if method.endswith("NodeHandle") and method.startswith("get"):
            return NodeHandle(self._need_node(call.span, whole), "~" if "Private" in method else "")
        is_unclear = isinstance(whole, UnknownText | Alternatives)
        is_ours = self.find_node(whole) is not None or is_unclear or name.startswith("rclcpp.")
        if method in ros_calls.TIMERS and (is_ours or name == "rospy.Timer"):
            periods = [seconds for each in call.arguments if (seconds := read_seconds(each)) is not None]
            self._need_node(call.span, whole, *call.arguments[:1]).periods.append(periods[0] if periods else None)
            return UnknownText("timer", call.span)
        parameter = self._read_parameter_call(call, name)
        if parameter is not NotImplemented or not is_ours:
            return parameter
        tables = [ros_calls.RCLCPP_METHODS] if self.is_cpp else [ros_calls.RCLPY_METHODS]
        # Words such as `subscribe` are used by others, too: clients of MQTT, for one.
        is_foreign = isinstance(whole, UnknownText) and bool(whole.foreign_type)
        tables += [ros_calls.ROSCPP_METHODS] if self.is_cpp and self.is_ros_1 and not is_foreign else []
        known = next((table[method] for table in tables if method in table), None)
        return NotImplemented if known is None else self._add_call(known, call, call.types)

    def _read_helper_call(self, whole: NodeHandle, call: RosCall) -> Value:
        if whole.kind == "image_transport" and ros_calls.read_image_call(call.method):
            return self._add_images(whole.node, whole.prefix, call.method, call.arguments, call.span)
        if whole.kind == "filter" and call.method == "subscribe" and len(call.arguments) > 1:
            self._add_filter(call, whole.message)
            return None
        return NotImplemented

    def _add_images(
        self, node: FoundNode, prefix: Value, method: str, arguments: Sequence[Value], span: Span
    ) -> UnknownText:
        use, has_info = ros_calls.read_image_call(method) or ("", False)
        name = _join_prefix(prefix, arguments[0]) if arguments else UnknownText(method, span)
        packed = [text for each in arguments[1:] if isinstance(text := settle(each), str) and text in PACKED_IMAGES]
        received, message = name, ros_calls.IMAGE_TYPES[0]
        if use == "subscribes" and packed:
            # Each transport has a topic of its own below that of the images.
            received, message = join_texts([name, "/", packed[0]]), PACKED_IMAGES[packed[0]]
        self._add(node, FoundEndpoint(use, "topic", received, message, span))
        if has_info:
            text = settle(name)
            beside: Value = UnknownText("camera_info beside it", span)
            if isinstance(text, str):
                folder, joint, _ = text.rpartition("/")
                beside = f"{folder}{joint}camera_info"
            self._add(node, FoundEndpoint(use, "topic", beside, ros_calls.IMAGE_TYPES[1], span))
        return UnknownText(method, span)

    def _add_call(self, known: EndpointCall, call: RosCall, types: Sequence[str]) -> UnknownText:
        nodes = [each for each in call.arguments if self.find_node(each) is not None]
        handle = call.whole if isinstance(call.whole, NodeHandle) else nodes[0] if nodes else None
        # Interfaces of a node stand in front in any number; the sisters of ROS 1 go without: `Subscriber(topic, type)`.
        rest = [each for each in call.arguments if self.find_node(each) is None]
        is_sister = known.has_node and self.is_ros_1 and not nodes
        call = replace(call, arguments=rest[int(known.has_node and not nodes and not is_sister) :])
        if is_sister and known.type_at is not None:
            known = known._replace(name_at=0, type_at=1)
        name = call.get(known.name_at, _NAME_KEYS)
        if isinstance(handle, NodeHandle):
            name = _join_prefix(handle.prefix, name)
        elif self.is_ros_1 and isinstance(call.whole, UnknownText):
            name = JoinedText((call.whole, name))
        message = read_message_name(types[0], known.flow) if types else ""
        if known.type_at is not None and not message:
            given = call.get(known.type_at, _TYPE_KEYS)
            text = settle(given) if isinstance(settle(given), str) else spell_external(given)
            message = read_message_name(text.replace("/", "."), known.flow)
        callback = None if message or known.callback_at is None else call.get(known.callback_at)
        if isinstance(callback, BoundFunction):
            message = read_message_name(self.expand_callback_type(callback), known.flow)
        qos = {} if self.is_ros_1 or known.qos_at is None else read_qos(call.get(known.qos_at, ("qos_profile",)))
        node = self._need_node(call.span, handle, call.whole)
        self._add(node, FoundEndpoint(known.use, known.flow, _write_private(name), message, call.span, qos))
        return UnknownText(call.method, call.span)

    def _add(self, node: FoundNode, endpoint: FoundEndpoint) -> None:
        endpoint.is_conditional = self.conditions > 0
        shown = show_value(endpoint.name)
        # What is not known is one thing where it stands in one place.
        key = (endpoint.use, endpoint.flow, shown, endpoint.span if "*" in shown else None)
        other = node.endpoints_by_name.setdefault(key, endpoint)
        if other is endpoint:
            node.endpoints.append(endpoint)
            return
        if endpoint.message not in {"", other.message}:
            # Which of two types it has is decided by something that is not known.
            other.message = "" if other.message else endpoint.message
        other.is_conditional &= endpoint.is_conditional

    # Parameters

    def _read_parameter_call(self, call: RosCall, name: str) -> Value:
        method, arguments, whole = call.method, call.arguments, call.whole
        is_module = name.rpartition(".")[0] in _PARAMETER_MODULES
        is_unclear = isinstance(whole, UnknownText) and method not in {"get", "param"}
        is_helper = method in PARAMETER_HELPERS
        if not (is_module or is_unclear or is_helper or self.find_node(whole)) or (method == "get" and not is_module):
            return NotImplemented
        if method == "declare_parameters" and isinstance(call.get(1), list):
            return [self._declare_listed(call, each) for each in arguments[1]]
        shift = int(bool(arguments) and self.find_node(arguments[0]) is not None)
        rest = arguments[shift + 1 :]
        if method not in _DECLARERS | _GETTERS or len(arguments) <= shift:
            return NotImplemented
        prefix = whole.prefix if isinstance(whole, NodeHandle) else ""
        parameter = settle(_join_prefix(prefix, arguments[shift]))
        if not isinstance(parameter, str):
            return UnknownText(f"the parameter {show_value(parameter)}", call.span)
        is_declared = method in _DECLARERS
        writes = self.is_cpp and method in _WRITING_GETTERS and rest and not (method == "param" and len(rest) == 1)
        default = (
            rest[0 if is_declared else -1] if rest and not (writes and len(rest) == 1) else UnknownText("", call.span)
        )
        default = next(
            (call.keywords[key] for key in ("value", "default", "alternative_value") if key in call.keywords), default
        )
        value = self._make_parameter(self._need_node(call.span, whole), parameter, default, call.span)
        return (shift + 1, value) if writes else value

    def _declare_listed(self, call: RosCall, item: Value) -> Value:
        name, *rest = item if isinstance(item, list) else [item]
        prefix = settle(call.arguments[0])
        if not isinstance(settle(name), str):
            return UnknownText("a parameter", call.span)
        full_name = f"{prefix}.{settle(name)}" if prefix else settle(name)
        default = rest[0] if rest else UnknownText("", call.span)
        return self._make_parameter(self._need_node(call.span, call.whole), full_name, default, call.span)

    def _make_parameter(self, node: FoundNode, name: str, default: Value, span: Span) -> ParameterValue:
        is_own = not self.is_ros_1 or name.startswith("~")
        plain = name.removeprefix("~").lstrip("/") if is_own else name
        if ".Type." in spell_external(default) or "PARAMETER_" in spell_external(default):
            # A type in place of a value.
            default = UnknownText("", span)
        if isinstance(default, UnknownText) and not default.text:
            default = node.defaults.get(plain, UnknownText(f"the parameter {name}", span))
        node.defaults[plain] = default
        key, own_name = plain.replace("/", "."), settle(node.name)
        by_name = self.node_parameters.get(own_name, {}) if isinstance(own_name, str) else {}
        given = next((each[key] for each in (self._given, by_name) if key in each), self._given.get("*"))
        given = given if is_own else None
        return ParameterValue(plain if is_own else "", default if given is None else given, default)


def _join_prefix(prefix: Value, name: Value) -> Value:
    """Return a name below what a node handle adds to names."""
    outer, inner = settle(prefix), settle(name)
    if not outer or (isinstance(inner, str) and inner.startswith(("/", "~"))):
        return name
    joined = join_texts([prefix, "/", name])
    return prefix if inner == "" else name if joined is NotImplemented else joined


def _write_private(name: Value) -> Value:
    """Return a private name of ROS 1 (`~map`) as both generations write it."""
    is_short = isinstance(name, str) and name.startswith("~") and not name.startswith("~/")
    return f"~/{name[1:]}" if is_short else name
