"""Read the types of fields: types of ROS, the project's conceptual types, messages; each perhaps as an array."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link.data_types.generic_types import TypeMention, is_bound_name, list_held_names
from archgen.link.shipped_interfaces import load_shipped_interfaces
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import ConceptualType, DataField, flow_of, full_message_name
from archgen.model.ros_distro import is_ros_1
from archgen.schema.quantity_wording import clip_text
from archgen.syntax.interface_types import FieldType, TypeComplaint, list_literal_types, read_field_type

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
