"""Read the types of fields: types of ROS, the project's conceptual types, messages; each perhaps as an array.

Make types of generic ones: `Envelope<Pose>` has the fields of `Envelope`, with `Pose` for its type parameter.

Add the types that are used and that nobody declares: messages, shipped types, and what generic types make.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from archgen.diagnostics import NO_SPAN, Diagnostic, Label, Span, did_you_mean, join_words
from archgen.frozen import NamedTuple, replace
from archgen.link.shipped_interfaces import load_shipped_interfaces
from archgen.model.generic_names import MAX_NAME_LENGTH, read_generic_name, write_generic_name
from archgen.model.message_types import PART_KEYS, ConceptualType, DataField, flow_of, full_message_name
from archgen.model.ros_distro import is_ros_1
from archgen.schema.quantity_wording import clip_text
from archgen.syntax.interface_literals import FieldType, TypeComplaint, list_literal_types, read_field_type

UNKNOWN_FIELD_TYPE = "unknown-field-type"
_ROS_WORDS = {True: frozenset({"time", "duration", "Header"}), False: frozenset({"time", "duration"})}
"""Types that ROS 1 (True) and ROS 2 know beside those that have literals."""
_PLACEHOLDER = "std_msgs/Empty"
"""A message that stands for one that is not known yet, where only the brackets behind it are judged."""
_MAX_GUESSES = 1_000
_NO_GUESS_HELP = "declare it below `types`, or write a type of ROS or a message: `float64`, `geometry_msgs/msg/Point`"


class TypeSources(NamedTuple):
    """What types are declared from, beside the project's files: what ships, and what could not be read."""

    project_id: str
    shipped_types: Mapping[str, ConceptualType]
    distro: str | None = None
    lost_keys: frozenset[str] = frozenset()
    damaged_elements: frozenset[str] = frozenset()
    is_partial: bool = False
    library_ids: Mapping[str, str] = {}
    """The libraries that types come from, by their names."""
    library_packages: Mapping[str, str] = {}
    """The packages of the messages that types of libraries define, by library."""


class FieldTypeReader:
    """Reads what fields hold, in the grammar of one ROS and with the types of one project."""

    def __init__(self, types: Mapping[str, ConceptualType], sources: TypeSources) -> None:
        self.ros1 = is_ros_1(sources.distro)
        self._types = types
        self._sources = sources
        self._guess_count = 0

    def read_type(self, field: DataField, holder: ConceptualType) -> FieldType | TypeComplaint | None:
        """Return what a field holds, or what is wrong with it; None where nobody knows it.

        A conceptual type without a message is its own name.
        """
        if field.type is None or field.element_type in holder.generic:
            return None
        return self._read_element(field.element_type, field.array)

    def _read_element(self, element_type: str, array: str) -> FieldType | TypeComplaint | None:
        """Return the type of ROS; None for one that is not known."""
        if self._is_ros_type(element_type):
            return read_field_type(f"{element_type}{array}", "", ros1=self.ros1)
        known_type = self._types.get(element_type)
        message = known_type.message if known_type else full_message_name(element_type)
        if message is None:
            placed = read_field_type(f"{_PLACEHOLDER}{array}", "", ros1=self.ros1) if known_type else None
            if not isinstance(placed, FieldType):
                return placed
            return FieldType(element_type, is_builtin=False, array=placed.array, size=placed.size)
        if flow_of(message) != "topic":
            noun = flow_of(message)
            article = "an" if noun == "action" else "a"
            return TypeComplaint(f"a field holds a message, and `{element_type}` is {article} {noun}")
        package, _, name = message.split("/")
        return read_field_type(f"{package}/{name}{array}", "", ros1=self.ros1)

    def _is_ros_type(self, name: str) -> bool:
        is_declared = name in self._types
        is_bounded_text = "<=" in name and not read_generic_name(name).arguments and not is_declared
        is_alias = name in _ROS_WORDS[self.ros1] and not is_declared
        return name in list_literal_types(ros1=self.ros1) or is_alias or is_bounded_text

    def find_unknown_names(self, mention: TypeMention) -> Iterator[Diagnostic]:
        """Report what a field names and nobody knows, or what a name of a generic type stands for."""
        names = list(list_held_names(mention.name, self._types))
        for name in names if mention.is_field else names[1:]:
            if not self._is_known(name, mention.parameters):
                help_line = self._suggest_type(name, mention.parameters)
                message = f"no type `{clip_text(name)}`"
                yield Diagnostic(UNKNOWN_FIELD_TYPE, message, mention.span, help=help_line, element=mention.element)

    def _is_known(self, name: str, parameters: Collection[str]) -> bool:
        may_be_unread = self._sources.is_partial or name in self._sources.lost_keys
        is_conceptual = name in self._types or name in self._sources.shipped_types or name in parameters
        is_conceptual = is_conceptual or is_bound_name(name, self._types)
        return is_conceptual or may_be_unread or self._is_ros_type(name) or full_message_name(name) is not None

    def _suggest_type(self, name: str, parameters: Collection[str]) -> str:
        complaint = read_field_type(name, "", ros1=self.ros1)
        if isinstance(complaint, TypeComplaint) and complaint.help and complaint.message.startswith("there is no type"):
            return complaint.help
        base, arguments = read_generic_name(name)
        if arguments and base in self._types:
            return f"`{base}` is no generic type: write `{base}`"
        # A guess compares a name with all others: of a hostile project's unknown names not each gets one.
        self._guess_count += 1
        if self._guess_count > _MAX_GUESSES:
            return _NO_GUESS_HELP
        ros_types = list_literal_types(ros1=self.ros1)
        guess = did_you_mean(name, {*ros_types, *parameters, *self._types, *self._sources.shipped_types})
        return guess or self._suggest_message(name) or _NO_GUESS_HELP

    def _suggest_message(self, name: str) -> str | None:
        """Suggest the message of that name, if only one package has one."""
        message = (
            load_shipped_interfaces(self._sources.distro).find_nearest(f"any/msg/{name}") if name.isalnum() else ""
        )
        return f"did you mean `{message}`?" if message and message.endswith(f"/msg/{name}") else None


_NAME_PART = re.compile(r"<=[0-9]+|[<>,]")


class TypeMention(NamedTuple):
    """A type as a port or a field names it, without the brackets of an array."""

    name: str
    span: Span
    element: str
    """The id of the component or the name of the type in which it stands."""
    parameters: tuple[str, ...] = ()
    """The type parameters of the type in which it stands."""
    is_field: bool = False


def list_held_names(name: str, types: Mapping[str, ConceptualType]) -> Iterator[str]:
    """Yield a name, and what it names if it is one of a generic type: `List<Pair<A, B>>`, `List`, `Pair<A, B>`, ..."""
    pending_names = [name]
    while pending_names:
        inner_name = pending_names.pop()
        yield inner_name
        if is_bound_name(inner_name, types):
            base, arguments = read_generic_name(inner_name)
            yield base
            pending_names += reversed(arguments)


def is_bound_name(name: str, types: Mapping[str, ConceptualType]) -> bool:
    """Whether a name is one of a generic type, with as many types as may be: `<` may stand in any type's name."""
    base, arguments = read_generic_name(name)
    return bool(arguments) and base in types and bool(types[base].generic)


def make_bound_type(name: str, types: Mapping[str, ConceptualType]) -> ConceptualType | None:
    """Return the type that a name such as `Envelope<Pose>` makes of a generic type; None for any other name."""
    base, arguments = read_generic_name(name)
    generic_type = types.get(base)
    if generic_type is None or not arguments or len(generic_type.generic) != len(arguments):
        return None
    stands_for = dict(zip(generic_type.generic, arguments, strict=True))
    return replace(
        generic_type,
        name=name,
        message=None,
        fields=None if generic_type.fields is None else _bind_fields(generic_type.fields, stands_for),
        part_fields={part: _bind_fields(fields, stands_for) for part, fields in generic_type.part_fields.items()},
        request=bind_name(generic_type.request, stands_for),
        response=bind_name(generic_type.response, stands_for),
        feedback=bind_name(generic_type.feedback, stands_for),
        generic=(),
        # Nothing declares it: it is used.
        at=NO_SPAN,
        message_at=NO_SPAN,
    )


def _bind_fields(fields: tuple[DataField, ...], stands_for: Mapping[str, str]) -> tuple[DataField, ...]:
    return tuple(
        replace(field, type=f"{bind_name(field.element_type, stands_for)}{field.array}") if field.type else field
        for field in fields
    )


def bind_name(name: str | None, stands_for: Mapping[str, str]) -> str | None:
    """Return a name with what the type parameters in it stand for: `List<T>` is `List<Pose>`."""
    if not name:
        return name
    # Only whole names between the marks are type parameters: `T` in `Twist` is none.
    pieces, position = list[str](), 0
    for mark in _NAME_PART.finditer(name):
        pieces += [_replace_word(name[position : mark.start()], stands_for), mark[0]]
        position = mark.end()
    pieces.append(_replace_word(name[position:], stands_for))
    return write_generic_name("".join(pieces))


def _replace_word(text: str, stands_for: Mapping[str, str]) -> str:
    word = text.strip()
    return text.replace(word, stands_for[word]) if word in stands_for else text


def find_unbound_names(mention: TypeMention, types: Mapping[str, ConceptualType]) -> Iterator[Diagnostic]:
    """Report generic types that are named without the types that they stand for, or with a wrong number of them."""
    pending_names = [mention.name]
    while pending_names:
        name = pending_names.pop()
        base, arguments = read_generic_name(name) if is_bound_name(name, types) else (name, ())
        pending_names += reversed(arguments)
        generic_type = types.get(base)
        if generic_type and name not in mention.parameters and len(generic_type.generic) != len(arguments):
            yield _diagnose_unbound_name(mention, generic_type, len(arguments))


def _diagnose_unbound_name(mention: TypeMention, generic_type: ConceptualType, count: int) -> Diagnostic:
    needed_count = len(generic_type.generic)
    needed_text = f"{needed_count} type{'s' * (needed_count > 1)} ({join_words(generic_type.generic, 'and')})"
    actual_text = "none is named" if not count else f"{count} {'is' if count == 1 else 'are'} named"
    example = f"{generic_type.name}<{', '.join(['Pose', 'Twist', 'Path'][i % 3] for i in range(needed_count))}>"
    return Diagnostic(
        "unbound-generic",
        f"`{generic_type.name}` is made for {needed_text}, and {actual_text}",
        mention.span,
        labels=(Label(generic_type.at, "declared here"),),
        help=f"write it as in `{example}`",
        element=mention.element,
    )


MAX_MADE_FIELDS = 20_000
"""Fields that a project may make of its generic types: each generic type in another one may double them."""


class OversizedType(NamedTuple):
    """A name that a port or a type uses, and why not all that follows from it is made."""

    name: str
    reason: str


class _PendingName(NamedTuple):
    """A name that is used, and the one in the project's files from which it follows."""

    name: str
    first_name: str
    is_field: bool = False


def add_used_types(
    types: dict[str, ConceptualType], used_names: Iterable[str], shipped_types: Mapping[str, ConceptualType]
) -> list[OversizedType]:
    """Add to the declared types those that ports and other types use; return what would be too large.

    A name that is a message is that message; then comes what a generic type makes of it, then the shipped type. A name
    that is none of these becomes a type without a message; in a field it is left to those who read fields. `used_names`
    is consumed lazily.
    """
    _bind_declared_types(types)
    adder = _TypeAdder(types, shipped_types)
    for each in list(types.values()):
        adder.add_names(_list_inner_names(each, each.name, types))
    for name in used_names:
        if name not in types:
            adder.add_names([_PendingName(name, name)])
    return adder.oversized_types


def _bind_declared_types(types: dict[str, ConceptualType]) -> None:
    """Give fields to types that are declared as `Envelope<Pose>: {message: ...}`, without fields of their own."""
    for name, declared in list(types.items()):
        bound_type = make_bound_type(name, types) if not declared.has_content else None
        if bound_type is not None:
            types[name] = replace(
                bound_type,
                message=declared.message,
                comment=declared.comment or bound_type.comment,
                size=declared.size or bound_type.size,
                status=declared.status or bound_type.status,
                version=declared.version or bound_type.version,
                deprecated=declared.deprecated or bound_type.deprecated,
                at=declared.at,
                message_at=declared.message_at,
            )


def _list_inner_names(
    holder: ConceptualType, first_name: str, types: Mapping[str, ConceptualType]
) -> Iterator[_PendingName]:
    """Yield the types that a type names, less those that its type parameters are part of."""
    names = [(name, False) for key in PART_KEYS if (name := getattr(holder, key))]
    names += [(field.element_type, True) for _, field in holder.list_fields() if field.type]
    for name, is_field in names:
        if not holder.generic or not any(held in holder.generic for held in list_held_names(name, types)):
            yield _PendingName(name, first_name, is_field)


class _TypeAdder:
    """Adds types by their names, each once."""

    def __init__(self, types: dict[str, ConceptualType], shipped_types: Mapping[str, ConceptualType]) -> None:
        self.oversized_types: list[OversizedType] = []
        self._types = types
        self._shipped_types = shipped_types
        self._made_count = 0

    def add_names(self, names: Iterable[_PendingName]) -> None:
        """Add types, and all that their fields name."""
        pending_names = [*reversed(list(names))]
        while pending_names:
            pending = pending_names.pop()
            # A type may itself name types, hence a work list; that each is added once also ends circles.
            if pending.name in self._types:
                continue
            is_bound = is_bound_name(pending.name, self._types)
            added_type = self._make_bound_type(pending) if is_bound else self._make_plain_type(pending)
            if is_bound:
                arguments = read_generic_name(pending.name).arguments
                pending_names += [_PendingName(name, pending.first_name, is_field=True) for name in arguments]
            if added_type is not None:
                self._types[pending.name] = added_type
                pending_names += _list_inner_names(added_type, pending.first_name, self._types)

    def _make_bound_type(self, pending: _PendingName) -> ConceptualType | None:
        generic_type = self._types[read_generic_name(pending.name).base]
        # Counted before they are made.
        self._made_count += 1 + sum(map(len, (generic_type.fields or (), *generic_type.part_fields.values())))
        if len(pending.name) > MAX_NAME_LENGTH:
            reason = f"makes types with names of more than {MAX_NAME_LENGTH} characters"
        elif self._made_count > MAX_MADE_FIELDS:
            reason = f"and other generic types make more than {MAX_MADE_FIELDS:,} fields"
        else:
            # As unbound as the generic type itself: that is reported, and that it has no message follows.
            unbound_type = ConceptualType(pending.name, generic=generic_type.generic)
            return make_bound_type(pending.name, self._types) or unbound_type
        self.oversized_types.append(OversizedType(pending.first_name, reason))
        return ConceptualType(pending.name, generic=generic_type.generic)

    def _make_plain_type(self, pending: _PendingName) -> ConceptualType | None:
        message, shipped_type = full_message_name(pending.name), self._shipped_types.get(pending.name)
        if pending.is_field and (message or shipped_type is None):
            return None
        if message:
            return ConceptualType(pending.name, message, origin="message")
        return (
            replace(shipped_type, name=pending.name, origin="shipped") if shipped_type else ConceptualType(pending.name)
        )
