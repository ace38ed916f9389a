"""Which ROS interfaces (messages, services, actions) exist, as far as archgen knows."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Literal

from archgen.diagnostics.suggestions import find_closest
from archgen.frozen import dataclass
from archgen.model.ros_distro import is_ros_1

KNOWN_DISTROS = ("jazzy", "humble", "kilted", "lyrical", "rolling", "noetic")
"""The distributions whose interfaces ship with archgen. The order counts: for a project without a distribution, the
first one that has a message defines its fields.
"""
InterfaceStatus = Literal["known", "wrong", "not held"]

_GENERATED_SUFFIXES = {
    "srv": re.compile(r"_(?:Request|Response|Event)\Z"),
    "action": re.compile(
        r"_(?:Goal|Result|Feedback|FeedbackMessage|(?:SendGoal|GetResult)(?:_(?:Request|Response|Event))?)\Z"
    ),
}
"""Suffixes of the interfaces that ROS 2 generates from services and actions, and that exist as soon as these do."""


PART_NAMES = {"msg": ("",), "srv": ("request", "response"), "action": ("goal", "result", "feedback")}
"""The parts of an interface, by its kind."""


@dataclass(frozen=True, slots=True)
class InterfaceField:
    """A field of an interface. `type` is the full one: `float64`, `string<=10`, `geometry_msgs/msg/Pose`; `array` is
    empty, `[]`, `[9]` or `[<=9]`.

    Only the project's own definitions give the default, as written, and the comment: that behind the field, with the
    lines right above it in front.
    """

    name: str
    type: str
    array: str = ""
    default: str = ""
    comment: str = ""


@dataclass(frozen=True, slots=True)
class InterfaceConstant:
    """A constant of an interface; the value is as written, the comment as that of a field."""

    name: str
    type: str
    value: str
    comment: str = ""


@dataclass(frozen=True, slots=True)
class Interface:
    """A message (one part), service (request, response) or action (goal, result, feedback) with its full name.

    `constants` are those of each part; `comment` is what stands by itself, one line for each of its lines. Only the
    project's own definitions give them.
    """

    name: str
    parts: tuple[tuple[InterfaceField, ...], ...]
    constants: tuple[tuple[InterfaceConstant, ...], ...] = ()
    comment: str = ""

    @property
    def part_names(self) -> tuple[str, ...]:
        """The names of the parts; that of a message's only part is empty."""
        return PART_NAMES[self.name.split("/")[1]]


@dataclass(frozen=True, slots=True)
class Interfaces:
    """All interfaces known for one distribution.

    All names of a package in `complete_packages` are known. Any other package may have names that archgen does not
    know: no name of it is ever wrong. `definitions` reads the shipped data on first use.
    """

    distro: str | None = None
    names: frozenset[str] = frozenset()
    complete_packages: frozenset[str] = frozenset()
    definitions: Mapping[str, Interface] = field(default_factory=dict, compare=False, repr=False)
    project_packages: frozenset[str] = frozenset()
    """Packages that the project defines itself."""
    has_names: bool = False
    """Whether archgen knows any names for this distribution."""
    mapper_names: tuple[str, ...] = ()
    """The type names of the shipped type mapper, if it is used: candidates for what an unmapped type may mean."""

    def status_of(self, message: str) -> InterfaceStatus:
        """Return whether `pkg/msg/Name` exists ("known"), does not exist ("wrong"), or is unknown ("not held")."""
        if message in self.names or self._base_name(message) in self.names:
            return "known"
        return "wrong" if message.split("/", 1)[0] in self.complete_packages else "not held"

    def known_packages(self) -> frozenset[str]:
        """Return the packages with at least one known interface."""
        return frozenset(name.split("/", 1)[0] for name in self.names)

    def find_nearest(self, message: str) -> str | None:
        """Return the interface that an unknown name most likely means: one of its package, else its namesake elsewhere.

        A namesake in another package counts if the packages' names are similar, or if it is the only one.
        """
        package, kind, short = message.split("/")
        # A name of the same package outranks a namesake elsewhere, however similar the packages are.
        package_names = self._index_by_name((name for name in self.names if name.startswith(f"{package}/")), kind)
        guess = find_closest(short, package_names)
        if guess is not None:
            return package_names[guess]
        namesake_packages = {name.split("/")[0] for name in self.names if name.endswith(f"/{kind}/{short}")}
        nearest_package = find_closest(package, namesake_packages) or (
            min(namesake_packages) if len(namesake_packages) == 1 else None
        )
        return f"{nearest_package}/{kind}/{short}" if nearest_package else None

    def _base_name(self, message: str) -> str:
        """Remove the suffix that ROS 2 appends to the names of what it generates from services and actions.

        ROS 1 generates messages with names of their own, which are listed like any others.
        """
        pattern = None if is_ros_1(self.distro) else _GENERATED_SUFFIXES.get(message.split("/")[1])
        return pattern.sub("", message) if pattern else message

    @staticmethod
    def _index_by_name(names: Iterable[str], kind: str) -> dict[str, str]:
        """Index full names by their last part; if two kinds share a last part, the wanted kind wins."""
        # Names of the wanted kind are sorted to the end: the last one written stays.
        names_by_end = dict[str, str]()
        for name in sorted(names, key=lambda name: (name.split("/")[1] == kind, name)):
            names_by_end[name.rsplit("/", 1)[1]] = name
        return names_by_end
