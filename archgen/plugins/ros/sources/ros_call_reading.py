"""What single calls of a program say to ROS: nodes, endpoints, parameters and timers, by the tables of `ros_calls`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from archgen.plugin.importing import Span
from archgen.plugins.ros.sources.ros_calls import (
    FIXED_ENDPOINTS,
    FIXED_PACKAGES,
    FUNCTIONS,
    IMAGE_CALLS,
    IMAGE_TYPES,
    NODE_CLASSES,
    RCLCPP_METHODS,
    RCLPY_METHODS,
    ROSCPP_METHODS,
    TIMERS,
    EndpointCall,
    change_qos,
    read_message_name,
    read_qos,
    read_seconds,
    spell_external,
)
from archgen.plugins.ros.sources.source_code import Function, SourceFile
from archgen.plugins.ros.sources.walk_values import (
    Alternatives,
    Callable,
    FoundEndpoint,
    FoundNode,
    JoinedText,
    NodeHandle,
    ParameterValue,
    UnknownText,
    WalkedObject,
    join_texts,
    settle,
    show_value,
)

_NAME_KEYS = ("topic", "topic_name", "srv_name", "action_name", "name", "service", "ns")
_TYPE_KEYS = ("msg_type", "srv_type", "action_type", "data_class", "service_class", "topic_type", "ActionSpec")
_GETTERS = frozenset(
    {"get_parameter", "get_parameter_or", "getParam", "getParamCached", "param", "get_param", "get", "get_param_cached"}
)
_DECLARERS = frozenset({"declare_parameter", "declare_parameter_if_not_declared", "declare_or_get_parameter"})
_PRIVATE = ("~/", "~")
_ROS_1_MODULES = frozenset({"rospy", "ros.param"})


class RosCallReader:
    """Keeps what was found so far. The walk asks it about each call."""

    def __init__(self, given: Mapping[str, Any], *, is_ros_1: bool) -> None:
        self._given = given
        self.is_ros_1 = is_ros_1
        self.nodes: list[FoundNode] = []
        self.current_node: FoundNode | None = None
        self.conditions = 0
        """How many conditions around the place are not known."""
        self.file: SourceFile | None = None
        self.open_functions: list[Function] = []
        self.last_arguments: Sequence[Any] = ()

    def expand_callback_type(self, callback: Callable) -> str:
        """Return the type of what a callback takes."""
        raise NotImplementedError

    # Nodes

    def make_node(self, span: Span) -> FoundNode:
        """Return a new node; in ROS 1 a process is one, whatever it makes."""
        if self.is_ros_1 and self.nodes:
            return self.nodes[0]
        node = FoundNode(span)
        self.nodes.append(node)
        self.current_node = self.current_node or node
        return node

    def name_node(
        self, node: FoundNode, arguments: Sequence[Any], keywords: Mapping[str, Any], *, is_cpp: bool
    ) -> None:
        """Keep the name and namespace that a constructor is given."""
        name = arguments[0] if arguments else keywords.get("node_name", keywords.get("name"))
        if isinstance(name, NodeHandle | WalkedObject) or (is_cpp and not arguments):
            return
        node.name = name
        second = arguments[1] if len(arguments) > 1 and is_cpp else keywords.get("namespace")
        node.namespace = second if isinstance(settle(second), str) else None

    def find_node(self, value: Any) -> FoundNode | None:  # noqa: ANN401 - any value
        """Return the node that a value is, or speaks through."""
        return value.node if isinstance(value, WalkedObject | NodeHandle) else None

    def _need_node(self, span: Span, *values: Any) -> FoundNode:  # noqa: ANN401 - any values
        found = next((node for value in values if (node := self.find_node(value)) is not None), None)
        return found or self.current_node or self.make_node(span)

    # Types of C++ whose objects speak to ROS by themselves, and what Python calls likewise

    def make_external(  # noqa: PLR0911 - one for each kind
        self, full_type: str, arguments: list[Any], keywords: Mapping[str, Any], span: Span, *, is_member: bool = False
    ) -> Any:  # noqa: ANN401 - any value
        """Return the object of a type of ROS that a program makes; None for another type, or one that waits for arguments."""
        plain, _, inner = full_type.partition("<")
        dotted = plain.replace("::", ".").removeprefix(".")
        types = (inner.removesuffix(">"),) if inner else ()
        package, _, last = dotted.rpartition(".")
        if dotted == "ros.NodeHandle":
            outer = arguments[0] if arguments and isinstance(arguments[0], NodeHandle) else None
            prefix = arguments[1] if outer and len(arguments) > 1 else arguments[0] if arguments and not outer else ""
            joined = _join_prefix(outer.prefix if outer else "", prefix)
            return NodeHandle(self._need_node(span), joined)
        if dotted in NODE_CLASSES and not is_member:
            node = self.make_node(span)
            node.is_lifecycle = "ifecycle" in dotted
            self.name_node(node, arguments, keywords, is_cpp="rclcpp" in dotted or "rclpy" not in dotted)
            return NodeHandle(node)
        if last == "ImageTransport" and arguments:
            handle = arguments[0]
            node = self._need_node(span, handle)
            return NodeHandle(node, handle.prefix if isinstance(handle, NodeHandle) else "", "image_transport")
        if dotted.startswith("message_filters.Subscriber"):
            message = read_message_name(types[0].partition(",")[0], "topic") if types else ""
            if len(arguments) > 1:
                self._add_filter(arguments, message, span)
            return NodeHandle(self._need_node(span, *arguments[:1]), "", "filter", message)
        if last == "SubscriberFilter" and len(arguments) > 1:
            self._add_filter(arguments, IMAGE_TYPES[0], span)
            return NodeHandle(self._need_node(span, *arguments[:1]), "", "filter", IMAGE_TYPES[0])
        if (
            last in FIXED_ENDPOINTS
            and package.partition(".")[0] in FIXED_PACKAGES
            and (arguments or not is_member or package == "tf")
        ):
            node = self._need_node(span, *arguments)
            for use, name, message in FIXED_ENDPOINTS[last]:
                self._add(node, FoundEndpoint(use, "topic", name, message, span))
            return NodeHandle(node, "", "fixed")
        if dotted in FUNCTIONS and types and arguments:
            self._add_call(FUNCTIONS[dotted], None, arguments, keywords, types, span)
            return UnknownText(last, span)
        return None

    def _add_filter(self, arguments: Sequence[Any], message: str, span: Span) -> None:
        is_node_first = self.find_node(arguments[0]) is not None
        name, rest = (arguments[1], arguments[2:]) if is_node_first else (arguments[0], arguments[1:])
        if is_node_first and isinstance(arguments[0], NodeHandle):
            name = _join_prefix(arguments[0].prefix, name)
        qos = {} if self.is_ros_1 or not rest else read_qos(rest[0])
        self._add(self._need_node(span, arguments[0]), FoundEndpoint("subscribes", "topic", name, message, span, qos))

    # Calls

    def read_call(  # noqa: PLR0911, PLR0913 - one for each kind; all that a call is
        self,
        whole: Any,  # noqa: ANN401 - any value
        target: Any,  # noqa: ANN401 - any value
        method: str,
        arguments: list[Any],
        keywords: Mapping[str, Any],
        types: Sequence[str],
        span: Span,
    ) -> Any:  # noqa: ANN401 - any value
        """Return what a call gives, with the place of the argument that it writes into; NotImplemented where it is none of ROS."""
        self.last_arguments = [*arguments, *keywords.values()]
        name = spell_external(target)
        if isinstance(whole, dict) and (changed := change_qos(whole, method, arguments)) is not None:
            return changed
        if isinstance(whole, NodeHandle) and whole.kind:
            return self._read_helper_call(whole, method, arguments, span)
        if name == "rospy.init_node":
            self.name_node(self._need_node(span), arguments, keywords, is_cpp=False)
            return None
        if name == "ros.init" and len(arguments) > 2:  # noqa: PLR2004 - two of main, then the name
            self._need_node(span).name = arguments[2]
            return None
        if name in FUNCTIONS:
            self._add_call(FUNCTIONS[name], whole, arguments, keywords, types, span)
            return UnknownText(name, span)
        if method in IMAGE_CALLS and name.startswith("image_transport."):
            node = self._need_node(span, *arguments[:1])
            return self._add_images(node, "", method, arguments[1:], span)
        if (
            name
            and (made := self.make_external(name + (f"<{types[0]}>" if types else ""), arguments, keywords, span))
            is not None
        ):
            return made
        if method in {"getNodeHandle", "getMTNodeHandle", "getPrivateNodeHandle", "getMTPrivateNodeHandle"}:
            return NodeHandle(self._need_node(span, whole), "~" if "Private" in method else "")
        is_ours = (
            self.find_node(whole) is not None
            or isinstance(whole, UnknownText | Alternatives)
            or name.startswith("rclcpp.")
        )
        if method in TIMERS and (is_ours or name == "rospy.Timer"):
            at = next((place for place, each in enumerate(arguments) if read_seconds(each) is not None), None)
            self._need_node(span, whole, *arguments[:1]).periods.append(
                None if at is None else read_seconds(arguments[at])
            )
            return UnknownText("timer", span)
        if name == "rospy.Timer" and arguments:
            self._need_node(span).periods.append(read_seconds(arguments[0]))
            return UnknownText("timer", span)
        parameter = self._read_parameter_call(whole, name, method, arguments, keywords, span)
        if parameter is not NotImplemented:
            return parameter
        if is_ours:
            for table in self._list_method_tables(arguments, keywords, types):
                if method in table:
                    self._add_call(table[method], whole, arguments, keywords, types, span)
                    return UnknownText(method, span)
        return NotImplemented

    def _list_method_tables(
        self, arguments: Sequence[Any], keywords: Mapping[str, Any], types: Sequence[str]
    ) -> list[Mapping[str, EndpointCall]]:
        is_cpp = self.file is not None and self.file.language == "cpp"
        if is_cpp:
            return [ROSCPP_METHODS, RCLCPP_METHODS] if self.is_ros_1 else [RCLCPP_METHODS]
        return [RCLPY_METHODS]

    def _read_helper_call(self, whole: NodeHandle, method: str, arguments: list[Any], span: Span) -> Any:  # noqa: ANN401 - any value
        if whole.kind == "image_transport" and method in IMAGE_CALLS:
            return self._add_images(whole.node, whole.prefix, method, arguments, span)
        if whole.kind == "filter" and method == "subscribe" and len(arguments) > 1:
            self._add_filter(arguments, whole.message, span)
            return None
        return NotImplemented

    def _add_images(self, node: FoundNode, prefix: Any, method: str, arguments: Sequence[Any], span: Span) -> Any:  # noqa: ANN401 - any value
        use, has_info = IMAGE_CALLS[method]
        name = _join_prefix(prefix, arguments[0]) if arguments else UnknownText(method, span)
        self._add(node, FoundEndpoint(use, "topic", name, IMAGE_TYPES[0], span))
        if has_info:
            text = settle(name)
            beside = (
                f"{text.rpartition('/')[0]}/camera_info".removeprefix("/" if not text.startswith("/") else "")
                if isinstance(text, str)
                else UnknownText("camera_info beside it", span)
            )
            self._add(node, FoundEndpoint(use, "topic", beside, IMAGE_TYPES[1], span))
        return UnknownText(method, span)

    def _add_call(  # noqa: PLR0913 - all that a call is
        self,
        call: EndpointCall,
        whole: Any,  # noqa: ANN401 - any value
        arguments: list[Any],
        keywords: Mapping[str, Any],
        types: Sequence[str],
        span: Span,
    ) -> None:
        if (
            call.node_at is not None
            and arguments
            and self.find_node(arguments[0]) is None
            and self.is_ros_1
            and call.name_at > 0
        ):
            # The sisters of ROS 1 take no node: `message_filters.Subscriber(topic, type)`.
            call = call._replace(name_at=0, type_at=None if call.type_at is None else 1, node_at=None)
        elif call.node_at is None and call.name_at == 0 and arguments and isinstance(arguments[0], NodeHandle):
            arguments = arguments[1:]
        name = _get_argument(arguments, call.name_at, keywords, _NAME_KEYS, span)
        handle = (
            whole
            if isinstance(whole, NodeHandle)
            else arguments[call.node_at]
            if call.node_at is not None and call.node_at < len(arguments)
            else None
        )
        if isinstance(handle, NodeHandle):
            name = _join_prefix(handle.prefix, name)
        elif self.is_ros_1 and isinstance(whole, UnknownText):
            name = JoinedText((whole, name))
        node = self._need_node(span, handle if handle is not None else whole, whole)
        message = ""
        if call.type_at is not None:
            given = _get_argument(arguments, call.type_at, keywords, _TYPE_KEYS, span)
            text = spell_external(given) or (settle(given).replace("/", ".") if isinstance(settle(given), str) else "")
            message = read_message_name(text, call.flow)
        elif types:
            message = read_message_name(types[0], call.flow)
        if not message and call.callback_at is not None and call.callback_at < len(arguments):
            callback = arguments[call.callback_at]
            if isinstance(callback, Callable):
                type_name = self.expand_callback_type(callback).removesuffix("::Request")
                message = read_message_name(type_name, call.flow)
        qos: dict[str, Any] = {}
        if not self.is_ros_1 and call.qos_at is not None:
            qos = read_qos(_get_argument(arguments, call.qos_at, keywords, ("qos_profile",), span))
        self._add(node, FoundEndpoint(call.use, call.flow, _write_private(name), message, span, qos))

    def _add(self, node: FoundNode, endpoint: FoundEndpoint) -> None:
        endpoint.is_conditional = self.conditions > 0
        shown = show_value(endpoint.name)
        for other in node.endpoints:
            if (
                (other.use, other.flow) == (endpoint.use, endpoint.flow)
                and show_value(other.name) == shown
                and ("*" not in shown or other.span == endpoint.span)
            ):
                if other.message and endpoint.message not in {"", other.message}:
                    # Which of two types it has is decided by something that is not known.
                    other.message = ""
                other.is_conditional &= endpoint.is_conditional
                return
        node.endpoints.append(endpoint)

    # Parameters

    def _read_parameter_call(  # noqa: PLR0913 - one for each kind; all that a call is
        self,
        whole: Any,  # noqa: ANN401 - any value
        name: str,
        method: str,
        arguments: list[Any],
        keywords: Mapping[str, Any],
        span: Span,
    ) -> Any:  # noqa: ANN401 - any value
        is_module = name.rpartition(".")[0] in _ROS_1_MODULES
        is_ours = (
            is_module
            or self.find_node(whole) is not None
            or (isinstance(whole, UnknownText) and method != "get" and method != "param")
        )
        is_ours = is_ours or (method == "declare_parameter_if_not_declared" and name.startswith(("nav2", "rclcpp")))
        if not is_ours or (method == "get" and not is_module):
            return NotImplemented
        if method == "declare_parameters" and len(arguments) > 1 and isinstance(arguments[1], list):
            return [self._declare_listed(arguments[0], each, span) for each in arguments[1]]
        if arguments and self.find_node(arguments[0]) is not None:
            arguments, shift = arguments[1:], 1
        else:
            shift = 0
        if method not in _DECLARERS | _GETTERS or not arguments:
            return NotImplemented
        parameter_name = (
            settle(_join_prefix(whole.prefix, arguments[0])) if isinstance(whole, NodeHandle) else settle(arguments[0])
        )
        node = self._need_node(span, whole)
        if not isinstance(parameter_name, str):
            return UnknownText(f"the parameter {show_value(parameter_name)}", span)
        rest = arguments[1:]
        if method in _DECLARERS:
            default = rest[0] if rest else keywords.get("value", UnknownText("", span))
            return self._make_parameter(node, parameter_name, default, span, is_declared=True)
        is_cpp = self.file is not None and self.file.language == "cpp"
        writes = (
            is_cpp
            and method in {"get_parameter", "get_parameter_or", "getParam", "getParamCached", "get", "param"}
            and rest
            and not (method == "param" and len(rest) == 1)
        )
        default = UnknownText("", span) if not rest or (writes and len(rest) == 1) else rest[-1]
        default = keywords.get("default", keywords.get("alternative_value", default))
        value = self._make_parameter(node, parameter_name, default, span, is_declared=self.is_ros_1)
        return (shift + 1, value) if writes else value

    def _declare_listed(self, prefix: Any, item: Any, span: Span) -> Any:  # noqa: ANN401 - any value
        parts = item if isinstance(item, list) else [item]
        name = settle(parts[0])
        if not isinstance(name, str):
            return UnknownText("a parameter", span)
        full_name = f"{settle(prefix)}.{name}" if settle(prefix) else name
        default = parts[1] if len(parts) > 1 else UnknownText("", span)
        return self._make_parameter(self._need_node(span), full_name, default, span, is_declared=True)

    def _make_parameter(
        self, node: FoundNode, name: str, default: Any, span: Span, *, is_declared: bool
    ) -> ParameterValue:
        plain = name
        is_own = not self.is_ros_1
        for mark in _PRIVATE:
            if name.startswith(mark):
                plain, is_own = name.removeprefix(mark), True
                break
        if ".Type." in spell_external(default) or "PARAMETER_" in spell_external(default):
            # A type in place of a value.
            default = UnknownText("", span)
        known = node.parameters.get(plain)
        if known is not None and isinstance(default, UnknownText) and not default.text:
            default = known
        if is_declared and is_own:
            node.parameters[plain] = default
        given = self._given.get(plain.replace("/", ".")) if is_own else None
        if given is None and isinstance(default, UnknownText) and not default.text:
            default = UnknownText(f"the parameter {name}", span)
        return ParameterValue(plain if is_own else "", default if given is None else given, default)


def _get_argument(
    arguments: Sequence[Any], place: int, keywords: Mapping[str, Any], keys: Sequence[str], span: Span
) -> Any:  # noqa: ANN401 - any value
    if place < len(arguments):
        return arguments[place]
    return next((keywords[key] for key in keys if key in keywords), UnknownText("its argument", span))


def _join_prefix(prefix: Any, name: Any) -> Any:  # noqa: ANN401 - a text, or its parts
    """Return a name below what a node handle adds to names."""
    outer, inner = settle(prefix), settle(name)
    if not outer or (isinstance(inner, str) and inner.startswith(("/", "~"))):
        return name
    if not inner and isinstance(inner, str):
        return prefix
    return join_texts([prefix, "/", name])


def _write_private(name: Any) -> Any:  # noqa: ANN401 - a text, or its parts
    """Return a private name of ROS 1 (`~map`) as both generations write it."""
    is_short = isinstance(name, str) and name.startswith("~") and not name.startswith("~/")
    return f"~/{name[1:]}" if is_short else name
