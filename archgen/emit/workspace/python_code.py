"""What a Python file of the user's own defines for a generated node, and what it uses of it: read by `ast`, never run."""

from __future__ import annotations

import ast
import hashlib
import re
import sys
import warnings
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from archgen.frozen import dataclass

_MAX_BYTES = 2_000_000
_INTERFACE_FOLDERS = frozenset({"msg", "srv", "action"})
_PLAIN_BASES = frozenset({"object", "ABC", "Protocol"})
_NODE_WORD = "node"
_DIGEST_LENGTH = 8
_PARTS = re.compile(r"(?:Request|Response|Goal|Result|Feedback|Action)\Z")
"""How classes of a part of a service or an action end in ROS 1."""
_HOLDING = (ast.List, ast.Tuple, ast.Set, ast.Dict, ast.ListComp, ast.SetComp, ast.DictComp)
_MAKING = frozenset({"list", "dict", "set", "deque"})
_COPYING = frozenset({"list", "tuple", "set", "sorted", "reversed", "iter", "next", "deque"})
_ADDING = frozenset({"append", "appendleft", "add", "insert", "setdefault"})
_TAKING = frozenset({"values", "get", "pop", "popleft", "copy"})
"""How lists and dictionaries are made, copied, given something, and asked for what they hold."""
_Function = ast.FunctionDef | ast.AsyncFunctionDef
_Trace = tuple[str, tuple[str, ...]]


class UnreadableCodeError(Exception):
    """A file is no Python that can be read; `line` is where, counted from 1."""

    def __init__(self, message: str, line: int = 1) -> None:
        """Remember where it is."""
        super().__init__(message)
        self.line = line


@dataclass(frozen=True, slots=True)
class OwnName:
    """A method that is defined, or something of the node that is used. Lines and columns count from 1.

    `message` is the package and the class that it is written with (`std_msgs`, `Float32`); None where the file does not say it.
    `digest` changes with the code of the function around it. Of a text, `reader` is the method that takes it.
    """

    name: str
    line: int
    column: int
    message: tuple[str, str] | None = None
    digest: str = ""
    reader: str = ""


@dataclass(frozen=True, slots=True)
class OwnField:
    """A field that is read, set, or given to a message that is made: the last one of `chain`.

    `root` is the class that the chain begins with (`std_msgs/msg/Float32`, `my_msgs/action/Pick/Goal`), else the method and the
    number of its argument: `receive_scan#0`, or what a call of the node answers with: `call_reset()`, `send_pick:Result()`, `send_pick:Feedback`.
    """

    root: str
    chain: tuple[str, ...]
    line: int
    column: int


@dataclass(frozen=True, slots=True)
class PythonCode:
    """What one file defines and uses."""

    class_name: str
    class_line: int
    methods: Mapping[str, OwnName]
    """Of all classes, and the functions that stand in none."""
    uses: tuple[OwnName, ...]
    """What it takes of the node: `self.node.publish_stop`."""
    texts: tuple[OwnName, ...]
    """Texts that it gives to the node: `self.node.get_parameter('lowest')`."""
    fields: tuple[OwnField, ...]
    own_words: frozenset[str]
    """All attributes that it reads of anything: a method that it calls itself is among them."""
    declares_parameters: bool
    foreign_base: str
    """A class of another file that its class inherits from; empty where there is none."""
    computed: tuple[OwnName, ...]
    """Where names are computed while it runs: `getattr(self.node, name)`."""


def read_python_code(data: bytes) -> PythonCode:
    """Read a file. Raise UnreadableCodeError where it is no Python, too long, or nested too deeply."""
    if len(data) > _MAX_BYTES:
        raise UnreadableCodeError(f"it has more than {_MAX_BYTES // 1_000_000} MB")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(data)
        return _CodeReader(tree, data.splitlines()).read()
    except SyntaxError as error:
        version = f"{sys.version_info.major}.{sys.version_info.minor}"
        raise UnreadableCodeError(f"it is no Python {version}: {error.msg}", error.lineno or 1) from None
    except (RecursionError, MemoryError):
        raise UnreadableCodeError("it is nested too deeply") from None
    except ValueError as error:  # bytes of no encoding, or zeros
        raise UnreadableCodeError(f"it is no text: {error}") from None


def names_message(written: tuple[str, str], message: str) -> bool:
    """Whether a class (`std_srvs`, `TriggerRequest`) is that of a message (`std_srvs/srv/Trigger`), or of a part of it."""
    package, _, name = message.partition("/")
    name = name.rpartition("/")[2]
    return written[0] == package and name in {written[1], _PARTS.sub("", written[1])}


class _CodeReader:
    """Collects the parts of one tree."""

    def __init__(self, tree: ast.Module, lines: Sequence[bytes]) -> None:
        self._tree, self._lines = tree, lines
        self._classes = [each for each in ast.walk(tree) if isinstance(each, ast.ClassDef)]
        self._imported: dict[str, str] = {}
        for each in ast.walk(tree):
            if isinstance(each, ast.ImportFrom) and each.module and not each.level:
                self._imported |= {alias.asname or alias.name: f"{each.module}.{alias.name}" for alias in each.names}
            elif isinstance(each, ast.Import):
                self._imported |= {alias.asname: alias.name for alias in each.names if alias.asname}
        self._own_class, self._node_words = self._find_own_class()
        # What it is called in the second place, too: `self.robot = node`, `robot = self.robot`.
        for _ in range(2):
            self._node_words |= set(self._find_node_words())
        self._outermost = frozenset(self._list_functions())
        self._kept: dict[str, _Trace] = {}
        self._answers: dict[str, dict[str, str]] = {}
        # What is kept may be called back, and what is called back may be kept.
        for _ in range(2):
            self._kept = self._find_kept()
            self._answers = self._find_answers()

    def read(self) -> PythonCode:
        methods: dict[str, OwnName] = {}
        homes: list[ast.ClassDef | ast.Module] = [*self._classes, self._tree]
        for each in homes:
            for function in each.body:
                if isinstance(function, _Function):
                    methods.setdefault(function.name, self._describe_method(function, each))
                elif isinstance(function, ast.Assign):  # `receive_b = receive_a`
                    for target in function.targets:
                        if isinstance(target, ast.Name):
                            methods.setdefault(target.id, _name_at(target.id, target))
        own_class = self._own_class
        uses, texts, computed = self._list_uses()
        reads = [each for each in ast.walk(self._tree) if isinstance(each, ast.Attribute)]
        return PythonCode(
            own_class.name if own_class else "",
            own_class.lineno if own_class else 1,
            methods,
            tuple(uses),
            tuple(texts),
            tuple(dict.fromkeys(self._list_fields())),
            frozenset(each.attr for each in reads),
            any(each.attr in {"declare_parameter", "declare_parameters"} for each in reads),
            self._find_foreign_base(own_class) if own_class else "",
            tuple(computed),
        )

    def _find_own_class(self) -> tuple[ast.ClassDef | None, set[str]]:
        """Return the class that the node makes, and what the node is called: it is what the class is made with."""
        made_with = [
            (each, function.args.args[1].arg)
            for each in self._classes
            for function in each.body
            if isinstance(function, _Function) and function.name == "__init__" and function.args.args[1:]
        ]
        chosen = sorted(made_with, key=lambda each: each[1] != _NODE_WORD)[:1]
        for own_class, word in chosen:
            return own_class, {_NODE_WORD, word}
        return next(iter(self._classes), None), {_NODE_WORD}

    def _find_foreign_base(self, own_class: ast.ClassDef) -> str:
        known = {*_PLAIN_BASES, *(each.name for each in self._classes)}
        bases = [ast.unparse(each) for each in own_class.bases]
        return next((each for each in bases if each.rpartition(".")[2].partition("[")[0] not in known), "")

    def _find_node_words(self) -> Iterator[str]:
        """Yield what else the node is called: `self.robot = node`, `robot = self.node`."""
        for each in ast.walk(self._tree):
            targets = [each.target] if isinstance(each, ast.AnnAssign) else getattr(each, "targets", ())
            if isinstance(each, ast.Assign | ast.AnnAssign) and _last_word(each.value) in self._node_words:
                yield from filter(None, map(_last_word, targets))

    def _describe_method(self, function: _Function, home: ast.AST) -> OwnName:
        # Behind `self`; of a static method it says nothing that could be wrong.
        arguments = (*function.args.posonlyargs, *function.args.args)[isinstance(home, ast.ClassDef) :]
        annotation = arguments[0].annotation if arguments else None
        if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
            try:
                annotation = ast.parse(annotation.value, mode="eval").body
            except SyntaxError:
                annotation = None
        return _name_at(function.name, function, self._find_message(annotation), self._digest(function))

    def _find_message(self, expression: ast.expr | None) -> tuple[str, str] | None:
        """Return package and class of an expression that names a message, or a part of a service or an action."""
        path = self._find_class(expression).split("/")
        return (path[0], path[2]) if path[1:] else None

    def _find_class(self, expression: ast.expr | None) -> str:
        """Return the class that an expression names (`my_msgs/action/Pick/Goal`); empty where it is none of a message."""
        words = _list_words(expression)
        path = [*self._imported.get(words[0], words[0]).split("."), *words[1:]] if words else []
        return "/".join(path) if len(path) > 2 and path[1] in _INTERFACE_FOLDERS else ""  # noqa: PLR2004 - std_msgs.msg.Bool

    def _list_fields(self) -> Iterator[OwnField]:
        for function in self._list_functions():
            if not isinstance(function, _Function):
                continue
            roots = self._find_roots(function)
            called = {id(each.func) for each in ast.walk(function) if isinstance(each, ast.Call)}
            for each in ast.walk(function):
                is_field = isinstance(each, ast.Attribute) and id(each) not in called and not _is_kept(each)
                if is_field and isinstance(each, ast.Attribute) and (traced := self._trace_fields(each, roots)):
                    column = (each.end_col_offset or 0) - len(each.attr.encode()) + 1
                    yield OwnField(*traced, each.end_lineno or each.lineno, column)
                elif isinstance(each, ast.Call) and (made := self._find_class(each.func)):
                    given = [keyword for keyword in each.keywords if keyword.arg]
                    yield from (OwnField(made, (str(at.arg),), at.lineno, at.col_offset + 1) for at in given)

    def _find_roots(self, function: _Function) -> dict[str, _Trace]:
        """Return what names of a function stand for: its arguments, and what is taken of them or made."""
        arguments = [each for each in (*function.args.posonlyargs, *function.args.args) if each.arg != "self"]
        roots: dict[str, _Trace] = {
            each.arg: (self._find_class(each.annotation) or f"{function.name}#{number}", ())
            for number, each in enumerate(arguments)
        }
        roots |= {name: (root, ()) for name, root in self._answers.get(function.name, {}).items()}
        # In the order of the text: `pose = message.pose`, `for point in pose.points`.
        bindings = [binding for each in ast.walk(function) for binding in _list_bindings(each)]
        for target, value in sorted(bindings, key=lambda each: each[0].lineno):
            for name, traced in self._trace_targets(target, value, roots):
                if isinstance(name, ast.Name):
                    is_another = name.id in roots and roots[name.id] != traced
                    roots[name.id] = traced if traced and not is_another else ("", ())
        return {name: root for name, root in roots.items() if root[0]}

    def _find_kept(self) -> dict[str, _Trace]:
        """Return what attributes stand for that are given one thing alone, and nothing: `self.asked = self.node.call_reset(request)`.

        A list, a set or a dictionary is called as what it holds; of what is unpacked, each part has its place: `waiting[1]`.
        """
        attributes = [each for each in ast.walk(self._tree) if isinstance(each, ast.Attribute)]
        unseen = Counter(each.attr for each in attributes if isinstance(each.ctx, ast.Store))
        given: dict[str, set[_Trace | None]] = {}
        for function in (each for each in self._list_functions() if isinstance(each, _Function)):
            roots = self._find_roots(function)
            for target, value in (binding for each in ast.walk(function) for binding in _list_bindings(each)):
                for name, traced in self._trace_targets(target, value, roots):
                    if isinstance(name, ast.Attribute):
                        unseen[name.attr] -= isinstance(name.ctx, ast.Store)
                        given.setdefault(name.attr, set()).add(traced)
                        parts = value.elts if isinstance(value, ast.Tuple) else ()
                        for place, part in enumerate(parts):  # `self.waiting.append((row, future))`
                            given.setdefault(f"{name.attr}[{place}]", set()).add(self._trace_fields(part, roots))
            for each in ast.walk(function):  # `self.asked = None`, `self.waiting = []`
                for target in getattr(each, "targets", ()) or [getattr(each, "target", None)]:
                    if isinstance(target, ast.Attribute) and _is_empty(getattr(each, "value", None)):
                        unseen[target.attr] -= 1
        single = {name: next(iter(traces)) for name, traces in given.items() if len(traces) == 1 and not unseen[name]}
        return {name: trace for name, trace in single.items() if trace}

    def _find_answers(self) -> dict[str, dict[str, str]]:
        """Return by function which of its names are futures of calls, or feedback: what is given as a callback is called with one."""
        answers: dict[str, dict[str, str]] = {}
        functions = {each.name: each for each in ast.walk(self._tree) if isinstance(each, _Function)}
        for outer in (each for each in self._list_functions() if isinstance(each, _Function)):
            roots = self._find_roots(outer)
            calls = [each for each in ast.walk(outer) if isinstance(each, ast.Call)]
            for callback, root in (found for each in calls for found in self._list_callbacks(each, roots)):
                given = callback if isinstance(callback, ast.Lambda) else functions.get(_last_word(callback))
                names = [argument.arg for argument in given.args.args if argument.arg != "self"] if given else []
                home = given.name if isinstance(given, _Function) and given in self._outermost else outer.name
                answers.setdefault(home, {}).update(dict.fromkeys(names[:1], root))
        return answers

    def _list_callbacks(self, call: ast.Call, roots: Mapping[str, _Trace]) -> Iterator[tuple[ast.expr, str]]:
        """Yield what a call gives to be called back, with what that is called with."""
        called = call.func
        if not isinstance(called, ast.Attribute):
            return
        if called.attr == "add_done_callback" and call.args:
            future = self._trace_fields(called.value, roots)
            if future and future[0].endswith("()"):
                yield call.args[0], future[0]
        elif called.attr.startswith("send_") and self._is_node(called.value):
            named = [each.value for each in call.keywords if each.arg == "feedback_callback"]
            yield from ((each, f"{called.attr}:Feedback") for each in (*call.args[1:2], *named))

    def _trace_targets(
        self, target: ast.expr, value: ast.expr, roots: Mapping[str, _Trace]
    ) -> Iterator[tuple[ast.expr, _Trace | None]]:
        """Yield names and attributes that are given something, with what that is; what takes an item is its list."""
        while isinstance(target, ast.Subscript):
            target = target.value
        if not isinstance(target, ast.Tuple | ast.List):
            yield target, self._trace_fields(value, roots)
            return
        for place, part in enumerate(target.elts):
            if isinstance(value, ast.Tuple) and len(value.elts) == len(target.elts):
                yield from self._trace_targets(part, value.elts[place], roots)
            else:
                yield part, self._trace_part(value, place, roots)

    def _trace_part(self, value: ast.expr, place: int, roots: Mapping[str, _Trace]) -> _Trace | None:
        """Return what stands at a place of each item that is unpacked: `for row, future in self.waiting`."""
        called = _last_word(value.func) if isinstance(value, ast.Call) else ""
        if isinstance(value, ast.Call) and called == "zip" and len(value.args) > place:
            return self._trace_fields(value.args[place], roots)
        if isinstance(value, ast.Call) and called in {"items", "enumerate"} and place == 1:
            held = value.func.value if isinstance(value.func, ast.Attribute) else next(iter(value.args), None)
            return self._trace_fields(held, roots) if held else None
        while isinstance(value, ast.Call) and called in _COPYING and value.args:
            value = value.args[0]
            called = _last_word(value.func) if isinstance(value, ast.Call) else ""
        return (
            self._kept.get(f"{value.attr}[{place}]") if isinstance(value, ast.Attribute) and _is_kept(value) else None
        )

    def _trace_fields(self, expression: ast.expr, roots: Mapping[str, _Trace]) -> _Trace | None:
        """Return where an expression begins and which fields it goes through; items of a list are what the list is called."""
        if isinstance(expression, ast.Name):
            return roots.get(expression.id)
        if isinstance(expression, ast.Subscript | ast.Await):
            return self._trace_fields(expression.value, roots)
        if isinstance(expression, ast.Call):
            return self._trace_call(expression, roots)
        if isinstance(expression, _HOLDING):
            traces = dict.fromkeys(self._trace_fields(each, roots) for each in _list_held(expression))
            return next(iter(traces)) if len(traces) == 1 else None
        if isinstance(expression, ast.Attribute) and _is_kept(expression):
            return self._kept.get(expression.attr)
        inner = self._trace_fields(expression.value, roots) if isinstance(expression, ast.Attribute) else None
        return (inner[0], (*inner[1], expression.attr)) if inner and isinstance(expression, ast.Attribute) else None

    def _trace_call(self, call: ast.Call, roots: Mapping[str, _Trace]) -> _Trace | None:
        """Return the class that a call makes, or whom it asks: its answer and the future of that are one."""
        if made := self._find_class(call.func):
            return made, ()
        taken = call.func
        if (
            isinstance(taken, ast.Attribute)
            and taken.attr.startswith(("call_", "send_"))
            and self._is_node(taken.value)
        ):
            return f"{taken.attr}()", ()
        if isinstance(taken, ast.Attribute) and taken.attr in {"result", "get_result_async"}:
            future = self._trace_fields(taken.value, roots)
            if not future or not future[0].endswith("()") or future[1]:
                return None
            return future if taken.attr == "result" else (future[0].replace("()", ":Result()"), ())
        if isinstance(taken, ast.Attribute) and taken.attr in _TAKING:
            return self._trace_fields(taken.value, roots)
        is_copied = isinstance(taken, ast.Name) and taken.id in _COPYING and call.args
        return self._trace_fields(call.args[0], roots) if is_copied else None

    def _list_uses(self) -> tuple[list[OwnName], list[OwnName], list[OwnName]]:
        uses: list[OwnName] = []
        texts: list[OwnName] = []
        computed: list[OwnName] = []
        for function in self._list_functions():
            digest = self._digest(function)
            made = self._find_made_messages(function)
            calls = {id(each.func): each for each in _walk_own(function) if isinstance(each, ast.Call)}
            for each in _walk_own(function):
                if isinstance(each, ast.Attribute) and self._is_node(each.value):
                    call = calls.get(id(each))
                    given = call.args[0] if call and call.args else None
                    message = made.get(given.id) if isinstance(given, ast.Name) else self._find_made(given)
                    uses.append(_name_at(each.attr, each, message, digest))
                    if call and isinstance(given, ast.Constant) and isinstance(given.value, str):
                        texts.append(_name_text(given.value, given, digest, each.attr))
                elif isinstance(each, ast.Subscript) and isinstance(each.slice, ast.Constant):
                    if isinstance(each.value, ast.Attribute) and self._is_node(each.value.value):
                        texts.append(_name_text(str(each.slice.value), each, digest, "[]"))
                elif isinstance(each, ast.Call) and _last_word(each.func) in {"getattr", "hasattr"} and each.args[1:]:
                    name = each.args[1]
                    if not self._is_node(each.args[0]):
                        continue
                    if isinstance(name, ast.Constant) and isinstance(name.value, str):
                        uses.append(OwnName(name.value, name.lineno, name.col_offset + 1, None, digest))
                    else:
                        computed.append(_name_at(ast.unparse(each), each))
        return [*dict.fromkeys(uses)], [*dict.fromkeys(texts)], [*dict.fromkeys(computed)]

    def _list_functions(self) -> Iterator[ast.AST]:
        """Yield the outermost functions, and the file for what stands in none."""
        yield self._tree
        for own_class in self._classes:
            yield from (each for each in own_class.body if isinstance(each, _Function))
        yield from (each for each in self._tree.body if isinstance(each, _Function))

    def _find_made_messages(self, function: ast.AST) -> dict[str, tuple[str, str]]:
        """Return the messages that a function makes under names that it gives to nothing else."""
        made: dict[str, set[tuple[str, str] | None]] = {}
        for each in _walk_own(function):
            if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
                made.setdefault(each.id, set())
            if isinstance(each, ast.Assign) and len(each.targets) == 1 and isinstance(each.targets[0], ast.Name):
                made.setdefault(each.targets[0].id, set()).add(self._find_made(each.value))
        return {name: known for name, all_made in made.items() if len(all_made) == 1 for known in all_made if known}

    def _find_made(self, expression: ast.expr | None) -> tuple[str, str] | None:
        return self._find_message(expression.func) if isinstance(expression, ast.Call) else None

    def _digest(self, function: ast.AST) -> str:
        if not isinstance(function, _Function):
            return ""
        lines = self._lines[function.lineno - 1 : function.end_lineno]
        return hashlib.sha256(b"\n".join(each.strip() for each in lines)).hexdigest()[:_DIGEST_LENGTH]

    def _is_node(self, expression: ast.expr) -> bool:
        return isinstance(expression, ast.Name | ast.Attribute) and _last_word(expression) in self._node_words


def _walk_own(function: ast.AST) -> Iterator[ast.AST]:
    """Yield what stands in a function, with functions inside; of a file, what stands in none of its functions and classes."""
    if not isinstance(function, ast.Module):
        yield from ast.walk(function)
        return
    for each in function.body:
        if not isinstance(each, _Function | ast.ClassDef):
            yield from ast.walk(each)


def _is_kept(attribute: ast.Attribute) -> bool:
    return isinstance(attribute.value, ast.Name) and attribute.value.id == "self"


def _is_empty(expression: ast.expr | None) -> bool:
    """Whether it is None, or a list or the like that holds nothing yet."""
    if isinstance(expression, ast.Call):
        return _last_word(expression.func) in _MAKING and not expression.args
    is_none = isinstance(expression, ast.Constant) and expression.value is None
    return is_none or (isinstance(expression, ast.List | ast.Set | ast.Dict | ast.Tuple) and not _list_held(expression))


def _list_held(expression: ast.expr) -> Sequence[ast.expr]:
    """Return what a list, a set, a tuple or a dictionary holds, by what it is written."""
    if isinstance(expression, ast.Dict):
        return expression.values
    if isinstance(expression, ast.DictComp):
        return [expression.value]
    return [expression.elt] if isinstance(expression, ast.ListComp | ast.SetComp) else getattr(expression, "elts", [])


def _list_bindings(node: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield what a part of a program gives a name, an attribute or a list, each with what it gives; what is empty is nothing."""
    value = node.iter if isinstance(node, ast.For | ast.comprehension) else getattr(node, "value", None)
    if isinstance(node, ast.For | ast.comprehension | ast.Assign | ast.AnnAssign) and value and not _is_empty(value):
        yield from ((each, value) for each in (node.targets if isinstance(node, ast.Assign) else [node.target]))
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.args:
        held = node.func.value
        if node.func.attr in _ADDING and (
            isinstance(held, ast.Name) or (isinstance(held, ast.Attribute) and _is_kept(held))
        ):
            yield held, node.args[-1]


def _list_words(expression: ast.expr | None) -> Sequence[str]:
    """Return the words of a dotted name; none for anything else."""
    words: list[str] = []
    while isinstance(expression, ast.Attribute):
        words.insert(0, expression.attr)
        expression = expression.value
    return [expression.id, *words] if isinstance(expression, ast.Name) else []


def _last_word(expression: ast.AST | None) -> str:
    words = _list_words(expression) if isinstance(expression, ast.expr) else ()
    return words[-1] if words else ""


def _name_text(text: str, node: ast.expr, digest: str, reader: str) -> OwnName:
    return OwnName(text, node.lineno, node.col_offset + 1, None, digest, reader)


def _name_at(
    name: str, node: ast.expr | _Function, message: tuple[str, str] | None = None, digest: str = ""
) -> OwnName:
    return OwnName(name, node.lineno, node.col_offset + 1, message, digest)
