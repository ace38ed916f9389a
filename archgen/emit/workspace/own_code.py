"""The user's own code held against what is generated around it: what it lacks, what it still uses, what changed under it.

A manifest says per file which names own code must define (`expects`) and which it may use (`offers`). A word is a name, with what it
stands for behind `=`: `receive_arms_left=base.guard.arms<arms.left.state:sensor_msgs/msg/JointState`, that is the element of the
model, where it hears it from, and its message. A name in quotes is a text, such as that of a parameter; behind a point stands a field
of a message, `.my_msgs/msg/Air.humidity`, and the message that it is.
The record of the workspace remembers what names meant, so that what is gone is told from what was never there, until it is mended.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import product

from archgen.diagnostics import find_closest
from archgen.emit.workspace.cpp_fields import find_field
from archgen.emit.workspace.python_code import (
    OwnField,
    OwnName,
    PythonCode,
    UnreadableCodeError,
    names_message,
    read_python_code,
)
from archgen.frozen import dataclass, field

_SENDING = ("publish_", "call_", "send_")
"""How methods of a generated node begin: own code has no other use for such a name of the node."""
_BY_KIND = {"execute_": "is an action", "send_": "is an action", "serve_": "is a service", "call_": "is a service"}
_LIFE_CYCLE = frozenset(
    f"on_{each}" for each in ("configure", "activate", "deactivate", "cleanup", "shutdown", "error")
)
_COMMENTS = re.compile(r"//[^\n]*|/\*(?:[^*]|\*(?!/))*\*/|\"(?:[^\"\\\n]|\\.)*\"")
_WORD = re.compile(r"\w+")
_PARAMETER_STRUCT = re.compile(r"\b(\w+)\s*=\s*[\w.>()-]*\bread_parameters\(\)")
"""What holds all parameters at once, in C++."""
_NEW = "+"
"""What the record puts before the meaning of a name that came while own code still used one that was lost."""
_ROS_PARAMETERS = re.compile(r"use_sim_time\Z|start_type_description_service\Z|qos_overrides\.")
_TEXT_READERS = frozenset({"get_parameter", "[]"})
"""What fails for a parameter that nobody declared."""


@dataclass(frozen=True, slots=True)
class Contract:
    """What a file must define, and what it may use, by name, each with what it stands for."""

    expects: Mapping[str, str] = field(default_factory=dict)
    offers: Mapping[str, str] = field(default_factory=dict)

    @property
    def names(self) -> dict[str, str]:
        """All of them."""
        return {**self.expects, **self.offers}


@dataclass(frozen=True, slots=True)
class CodeFinding:
    """What is wrong with own code. `line` and `column` count from 1; 0 where no line is to blame."""

    message: str
    line: int = 0
    column: int = 0
    is_note: bool = False
    """Whether nothing has to be done about it."""
    path: str = ""
    """The file, where it is not the one that was judged."""
    old_name: str = ""
    new_name: str = ""
    """What most likely took the place of the old name; both are empty where nothing did."""


@dataclass(frozen=True, slots=True)
class CodeReport:
    """The findings of a file, and what its names mean to it from now on, for the record."""

    findings: tuple[CodeFinding, ...] = ()
    meanings: Mapping[str, str] = field(default_factory=dict)


def read_contract(expected_words: Iterable[str], offered_words: Iterable[str]) -> Contract:
    """Read the words of a manifest."""
    return Contract(dict(_split_words(expected_words)), dict(_split_words(offered_words)))


def _split_words(words: Iterable[str]) -> Iterator[tuple[str, str]]:
    for word in words:
        name, _, meaning = word.partition("=")
        yield name, meaning


def has_lost_names(offered_words: Iterable[str], recorded: Mapping[str, str]) -> bool:
    """Whether the node had methods for sending that it has no more: other files of the user's may use them."""
    offered = {name for name, _ in _split_words(offered_words)}
    return any(name.startswith(_SENDING) and name not in offered for name in recorded)


def judge_own_code(
    path: str,
    data: bytes,
    contract: Contract,
    recorded: Mapping[str, str],
    helpers: Iterable[tuple[str, bytes]] = (),
) -> CodeReport:
    """Hold a file of the user's own against what is generated around it. `recorded` is what its names meant before.

    `helpers` are other files of his beside it, by path: what they use of the node and is gone is told, too.
    """
    if path.endswith(".py"):
        try:
            return _PythonJudge(read_python_code(data), contract, recorded).judge(helpers)
        except UnreadableCodeError as error:
            message = f"cannot be held against the model: {error}"
            return CodeReport((CodeFinding(message, error.line, 1),), recorded)
    return _judge_words(data.decode("utf-8", "replace"), contract, recorded)


@dataclass(frozen=True, slots=True)
class _Meaning:
    """What a name stands for: the element of the model, whom it hears, the message, and the code that was written for it."""

    element: str
    source: str
    message: str
    digest: str = ""

    @classmethod
    def read(cls, text: str) -> _Meaning:
        """Read what a manifest says, with the digest that the record puts behind it."""
        meaning, _, digest = text.removeprefix(_NEW).partition(" ")
        origin, _, message = meaning.partition(":")
        element, _, source = origin.partition("<")
        return cls(element, source, message, digest)


def _find_successor(name: str, contract: Contract, recorded: Mapping[str, str], taken: Collection[str]) -> str:
    """Return the new name that a lost one most likely has; empty where none is likely.

    Only a name that is new can be it: one that stands for the same element or hears the same, else the only one with the same message, else a similar one.
    """
    kind = _find_kind(name)
    known = {each for each, meaning in recorded.items() if each == name or not meaning.startswith(_NEW)}
    fresh = {
        each: _Meaning.read(meaning)
        for each, meaning in contract.names.items()
        if _find_kind(each) == kind and each not in taken and not {each, name} <= known
    }
    old = _Meaning.read(recorded.get(name, ""))
    for alike in (
        [each for each, new in fresh.items() if old.source and new.source == old.source],
        [each for each, new in fresh.items() if old.element and new.element == old.element],
        [each for each, new in fresh.items() if old.message and new.message == old.message],
    ):
        if len(alike) == 1:
            return alike[0]
    # What all of the kind begin with resembles nothing.
    closest = find_closest(name.removeprefix(kind), [each.removeprefix(kind) for each in fresh])
    return f"{kind}{closest}" if closest else ""


def _describe_other_use(name: str, contract: Contract, recorded: Mapping[str, str]) -> str:
    """Return that what a lost name stood for is an action now, and was a service, or the reverse; empty where it is not."""
    element = _Meaning.read(recorded.get(name, "")).element
    now = [each for each, text in contract.names.items() if element and _Meaning.read(text).element == element]
    if not now or any(_find_kind(each) == _find_kind(name) for each in now):
        return ""
    became = _BY_KIND.get(_find_kind(now[0]), "") if _find_kind(name) in _BY_KIND else ""
    return f"`{element}` {became} now, with `{'`, `'.join(now)}`" if became else ""


def _describe_successor(
    name: str, contract: Contract, recorded: Mapping[str, str], taken: Collection[str]
) -> tuple[str, str]:
    """Return what is said of what took the place of a lost name, and the new name; both empty where nothing did."""
    if other_use := _describe_other_use(name, contract, recorded):
        return f": {other_use}", ""
    successor = _find_successor(name, contract, recorded, taken)
    return (f"; it is most likely `{successor}` now" if successor else ""), successor


def _mark_new_names(meanings: Mapping[str, str], contract: Contract, recorded: Mapping[str, str]) -> dict[str, str]:
    """Mark what is new while something lost of its kind waits to be mended: it stays a likely successor until then."""
    waiting = {_find_kind(name) for name in meanings if name not in contract.names}

    def is_new(name: str) -> bool:
        is_known = name in recorded and not recorded[name].startswith(_NEW)
        return name in contract.names and _find_kind(name) in waiting and not is_known

    return {name: f"{_NEW * is_new(name)}{meaning.removeprefix(_NEW)}" for name, meaning in meanings.items()}


def _describe_lost_field(name: str, contract: Contract, recorded: Mapping[str, str]) -> tuple[str, str]:
    """Return what is said of a field that a message has no more, and its likely new name; nothing where no port has the message."""
    head, _, field_name = name.rpartition(".")
    known = [each for each in contract.offers if each.rpartition(".")[0] == head]
    fresh = [each.rpartition(".")[2] for each in known if recorded.get(each, _NEW).startswith(_NEW)]
    lost = [each for each in recorded if each.rpartition(".")[0] == head and each not in contract.offers]
    successor = fresh[0] if len(fresh) == len(lost) == 1 else find_closest(field_name, fresh) or ""
    now = f"; it is most likely `{successor}` now" if successor else ""
    return (f"`{head[1:]}` has no field `{field_name}` any more{now}" if known else ""), successor


def _find_kind(name: str) -> str:
    return name[0] if name.startswith(("'", ".")) else f"{name.partition('_')[0]}_"


class _PythonJudge:
    """Compares one Python file with its contract."""

    def __init__(self, code: PythonCode, contract: Contract, recorded: Mapping[str, str]) -> None:
        self._code, self._contract, self._recorded = code, contract, recorded
        self._findings: list[CodeFinding] = []
        self._meanings: dict[str, str] = {}
        self._successors: set[str] = set()
        # A name that is gone has the fields that it had: both are told, in whichever order they are mended.
        self._known = {**recorded, **contract.names}

    def judge(self, helpers: Iterable[tuple[str, bytes]]) -> CodeReport:
        lost = {name for name in self._recorded if name.startswith(_SENDING) and name not in self._contract.offers}
        # Looked at only then: there may be many.
        for path, data in helpers if lost else ():
            self._find_lost_uses_in_helper(path, data, lost)
        self._find_orphans()
        self._find_lacking()
        self._find_lost_uses()
        self._find_lost_texts()
        self._find_lost_fields()
        self._find_changed_meanings()
        for each in self._code.computed:
            words = f"`{each.name}` computes a name: archgen cannot see whether the node has it"
            self._tell(words, each, is_note=True)
        findings = sorted(self._findings, key=lambda each: (each.path, each.line, each.column, each.message))
        return CodeReport(tuple(findings), _mark_new_names(self._meanings, self._contract, self._recorded))

    def _tell(self, message: str, at: OwnName, *, is_note: bool = False, successor: str = "") -> None:
        names = (at.name, successor.strip("'")) if successor else ("", "")
        self._findings.append(CodeFinding(message, at.line, at.column, is_note, "", *names))

    def _keep(self, name: str) -> None:
        """Remember what a name meant, so that it is told again until somebody mends it."""
        self._meanings[name] = self._recorded[name]

    def _find_orphans(self) -> None:
        """Methods that were called for the model, and are no more."""
        lost = [name for name in self._recorded if name in self._code.methods and name not in self._contract.names]
        for name in lost:
            if name in self._code.own_words:
                continue
            other_use = _describe_other_use(name, self._contract, self._recorded)
            taken = {*self._code.methods, *self._successors}
            successor = "" if other_use else _find_successor(name, self._contract, self._recorded, taken)
            element = _Meaning.read(self._recorded[name]).element
            if successor:
                self._successors.add(successor)
                now = _Meaning.read(self._contract.expects.get(successor, "")).element
                of = f" (`{now}`, not `{element}`)" if element and now and element != now else ""
                text = f"nobody calls `{name}` any more; it is most likely `{successor}` now{of}, which is lacking"
            elif other_use:
                text = f"nobody calls `{name}` any more: {other_use}"
            elif name == "on_parameters":
                text = "nobody calls `on_parameters` any more: the node has no parameters"
            elif name in _LIFE_CYCLE:
                text = f"nobody calls `{name}` any more: the node has no life cycle"
            elif name.startswith("on_timer"):
                text = f"nobody calls `{name}` any more: the model gives it no rate, so nothing happens by the clock"
            else:
                text = (
                    f"nobody calls `{name}` any more: the model has no {f'`{element}`' if element else 'port'} for it"
                )
            self._tell(text, self._code.methods[name], successor=successor)
            self._keep(name)

    def _find_lacking(self) -> None:
        lacking = [
            name for name in self._contract.expects if name not in self._code.methods and name not in self._successors
        ]
        if not lacking:
            return
        at = OwnName(self._code.class_name, self._code.class_line, 1)
        if self._code.foreign_base:
            words = f"`{self._code.foreign_base}`, of another file, has to define {', '.join(lacking)}"
            self._tell(f"{words}: `{self._code.class_name}` does not", at, is_note=True)
            return
        for name in lacking:
            element = _Meaning.read(self._contract.expects[name]).element
            of = f", which is called for `{element}`" if element else ""
            owner = f"`{self._code.class_name}`" if self._code.class_name else "it"
            self._tell(f"{owner} lacks `{name}`{of}", at)

    def _find_lost_uses(self) -> None:
        for use in self._code.uses:
            is_sending = use.name.startswith(_SENDING) and use.name not in self._code.methods
            was_offered = use.name in self._recorded and use.name.startswith(_SENDING)
            if use.name in self._contract.offers or not (is_sending or was_offered):
                continue
            now, successor = _describe_successor(use.name, self._contract, self._recorded, ())
            any_more = " any more" if was_offered else ""
            self._tell(f"the node has no `{use.name}`{any_more}{now}", use, successor=successor)
            if was_offered:
                self._keep(use.name)

    def _find_lost_uses_in_helper(self, path: str, data: bytes, lost: Collection[str]) -> None:
        """Tell what another file uses of what it calls the node, where that had it."""
        # Reading it as Python takes long, and most files know nothing of the node.
        if not any(name.encode() in data for name in lost):
            return
        try:
            uses = read_python_code(data).uses
        except UnreadableCodeError:
            return  # a template, or a file of another Python: it is nobody's own class
        for use in uses:
            if use.name in lost:
                now, successor = _describe_successor(use.name, self._contract, self._recorded, ())
                message = f"the node of `{self._code.class_name}` has no `{use.name}` any more{now}"
                names = (use.name, successor) if successor else ("", "")
                self._findings.append(CodeFinding(message, use.line, use.column, False, path, *names))  # noqa: FBT003
                self._keep(use.name)

    def _find_lost_texts(self) -> None:
        known = {name.strip("'") for name in self._contract.offers if name.startswith("'")}
        for text in self._code.texts:
            quoted = f"'{text.name}'"
            was_offered = quoted in self._recorded
            is_asked = text.reader in _TEXT_READERS and known and not self._code.declares_parameters
            if text.name in known or _ROS_PARAMETERS.match(text.name) or not (was_offered or is_asked):
                continue
            successor = _find_successor(quoted, self._contract, self._recorded, ())
            if not was_offered and not successor:
                continue  # a parameter that somebody else may have declared
            now = f"; it is most likely `{successor.strip(chr(39))}` now" if successor else ""
            message = f"the node has no parameter `{text.name}`{' any more' if was_offered else ''}{now}"
            self._tell(message, text, successor=successor)
            if was_offered:
                self._keep(quoted)

    def _find_lost_fields(self) -> None:
        for use in self._code.fields if any(each.startswith(".") for each in self._recorded) else ():
            class_name, chain = self._find_class(use)
            for inner in chain[:-1]:
                class_name = _Meaning.read(self._contract.offers.get(f".{class_name}.{inner}", "")).message
            name = f".{class_name}.{chain[-1]}" if chain else ""
            if name in self._recorded and name not in self._contract.offers:
                message, successor = _describe_lost_field(name, self._contract, self._recorded)
                if message:
                    self._tell(message, OwnName(chain[-1], use.line, use.column), successor=successor)
                    self._keep(name)

    def _find_class(self, use: OwnField) -> tuple[str, tuple[str, ...]]:
        """Return the class that a chain of fields begins with, and the chain: that of an argument is what the node calls with."""
        called, _, part = use.root.removesuffix("()").partition(":")
        if part or called != use.root:  # what a call of the node answers with
            answered = _Meaning.read(self._known.get(called, "")).message
            if called.startswith("call_"):
                return f"{answered}/Response", use.chain
            # A handle has fields of its own; result and feedback stand in a message that says whose they are.
            return f"{answered}/{part}", use.chain[1:] if part and use.chain[0] == part.lower() else ()
        method, _, number = use.root.partition("#")
        message = _Meaning.read(self._known.get(method, "")).message
        if not (number and message):
            return ("" if number else use.root), use.chain
        if method.startswith("serve_"):
            return f"{message}/{'Response' if int(number) else 'Request'}", use.chain
        if method.startswith("execute_"):
            return f"{message}/Goal", use.chain[1:] if use.chain[0] == "request" else ()
        return message, use.chain

    def _find_changed_meanings(self) -> None:
        self._meanings |= {name: text for name, text in self._contract.offers.items() if name.startswith(".")}
        for name, text in self._contract.names.items():
            if name.startswith("."):
                continue
            at = [self._code.methods[name]] if name in self._contract.expects and name in self._code.methods else []
            at += [each for each in self._code.uses if each.name == name and name in self._contract.offers]
            at += [each for each in self._code.texts if f"'{each.name}'" == name]
            new, old = _Meaning.read(text), _Meaning.read(self._recorded.get(name, text))
            is_one_of_several = bool(new.source) and not name.endswith(new.element.rpartition(".")[2])
            unsaid = [each for each in at if each.message is None or is_one_of_several]
            digest = "".join(dict.fromkeys(each.digest for each in unsaid if new.message))
            said = [each for each in at if each.message and new.message]
            wrong = [each for each in said if not names_message(each.message or ("", ""), new.message)]
            for each in wrong:
                written = f"{each.message[0]}/{each.message[1]}" if each.message else ""
                self._tell(f"`{name}` has `{new.message}` now, and not `{written}`", each)
            is_pending = bool(unsaid) and bool(old.digest) and old.digest == digest
            changes = [
                f"`{name.strip(chr(39))}` {verb} `{after}` now, and {past} `{before}`"
                for before, after, verb, past in (
                    (old.source if is_one_of_several else "", new.source, "hears", "heard"),
                    (old.message, new.message, *(("is", "was") if name.startswith("'") else ("has", "had"))),
                )
                if before and after and before != after
            ]
            if changes and is_pending:
                for each, words in product(unsaid, changes):
                    if each not in wrong or f"`{new.message}` now" not in words:
                        self._tell(f"{words}: what is written here was written for that", each)
                self._meanings[name] = self._recorded[name]
            else:
                self._meanings[name] = f"{text} {digest}".strip()


def _judge_words(text: str, contract: Contract, recorded: Mapping[str, str]) -> CodeReport:
    """Judge code that is not parsed, such as C++, by its words; what stands in comments and texts is none."""
    places: dict[str, tuple[int, int]] = {}
    line, start = 1, 0
    # Of the same length, so that places are those of the text.
    code = _COMMENTS.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    for found in _WORD.finditer(code):
        line += code.count("\n", start, found.start())
        start = found.start()
        places.setdefault(found[0], (line, found.start() - code.rfind("\n", 0, found.start())))
    lacking = [each for each in contract.expects if each not in places and not _holds_phrase(text, each)]
    findings, meanings = list[CodeFinding](), dict(contract.names)
    successors: set[str] = set()
    changed = [
        *_find_changed_messages(code, contract, recorded),
        *_find_lost_parameters(text, code, contract, recorded),
        *_find_lost_fields_in_words(code, contract, recorded),
    ]
    for name, message, position in changed:
        findings.append(CodeFinding(message, *_find_place(code, position)))
        meanings[name] = recorded[name]
    for name in recorded:
        if name in contract.names or name not in places:
            continue
        now, successor = _describe_successor(name, contract, recorded, {*places, *successors})
        successors.add(successor)
        names = (name, successor) if successor else ("", "")
        message = f"`{name}` is nothing that is generated any more{now}"
        findings.append(CodeFinding(message, *places[name], False, "", *names))  # noqa: FBT003
        meanings[name] = recorded[name]
    lacking = [each for each in lacking if each not in successors]
    if lacking:
        findings.append(CodeFinding(f"it lacks {', '.join(lacking)}"))
    findings.sort(key=lambda each: (each.line == 0, each.line, each.column))
    return CodeReport(tuple(findings), _mark_new_names(meanings, contract, recorded))


def _find_place(code: str, position: int) -> tuple[int, int]:
    return code.count("\n", 0, position) + 1, position - code.rfind("\n", 0, position)


def _find_changed_messages(
    code: str, contract: Contract, recorded: Mapping[str, str]
) -> Iterator[tuple[str, str, int]]:
    """Yield the names whose message is another one now, where code says the old one, with words and the place."""
    now = {name: _Meaning.read(text).message for name, text in contract.names.items()}
    for name, new in now.items():
        old = _Meaning.read(recorded.get(name, "")).message
        if name.startswith("'") or not (old and new) or old == new:
            continue
        old_class = re.escape(old.replace("/", "::"))
        if name not in contract.expects and old in now.values():
            continue  # another port still has it
        where = rf"\b{name}\s*\([^{{;]{{0,1000}}?" if name in contract.expects else ""
        if found := re.search(rf"{where}\b{old_class}\b", code):
            yield name, f"`{name}` has `{new}` now, and not `{old}`", found.start()


def _find_lost_parameters(
    text: str, code: str, contract: Contract, recorded: Mapping[str, str]
) -> Iterator[tuple[str, str, int]]:
    """Yield the parameters that are gone and that code reads: `read_parameters().speed`, `get_parameter("speed")`."""
    lost = [name for name in recorded if name.startswith("'") and name not in contract.names]
    if not lost:
        return
    structs = [re.escape(found[1]) for found in _PARAMETER_STRUCT.finditer(code)]
    member = "|".join([r"\bread_parameters\(\)", *(rf"\b{each}" for each in structs)])
    for name in lost:
        own_name = re.escape(name.strip("'"))
        read = re.compile(rf'(?:{member})\s*\.\s*(?={own_name}\b)|\bget_parameter\s*\(\s*"(?={own_name}")')
        # What stands in a comment is none; a text of code is blank in it, too, but for what stands before.
        found = next((each for each in read.finditer(text) if code[each.start()] == text[each.start()]), None)
        if found:
            successor = _find_successor(name, contract, recorded, ()).strip("'")
            of = f"; it is most likely `{successor}` now" if successor else ""
            yield name, f"the node has no parameter `{name.strip(chr(39))}` any more{of}", found.end()


def _find_lost_fields_in_words(
    code: str, contract: Contract, recorded: Mapping[str, str]
) -> Iterator[tuple[str, str, int]]:
    """Yield the fields that are gone and that code takes of what it declares with the class: `message->speed`."""
    for name in (each for each in recorded if each.startswith(".") and each not in contract.offers):
        head, _, field_name = name.rpartition(".")
        # Of names that stand for several classes nobody knows which one it is.
        is_elsewhere = any(each.startswith(".") and each.rpartition(".")[2] == field_name for each in contract.offers)
        service = head[1:].removesuffix("/Response")
        names = {**recorded, **contract.offers}
        calls = [each for each, text in names.items() if _Meaning.read(text).message == service]
        found = find_field(code, field_name, head[1:].replace("/", "::"), calls)
        message, _ = _describe_lost_field(name, contract, recorded)
        if found and message and not is_elsewhere:
            yield name, message, found.end()


def _holds_phrase(text: str, phrase: str) -> bool:
    """Whether a text holds words with what stands between them: `arm.move`."""
    return not phrase.isidentifier() and re.search(rf"(?<!\w){re.escape(phrase)}(?!\w)", text) is not None
