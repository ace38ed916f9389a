"""Which ROS interfaces (messages, services, actions) exist, as far as archgen knows."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.distro import is_ros_1
from archgen.suggest import closest

DISTROS = ("jazzy", "humble", "kilted", "lyrical", "rolling", "noetic")
"""The distributions whose interfaces ship with archgen. The order counts: for a project without a distribution, the
first one that has a message defines its fields.
"""
Answer = Literal["known", "wrong", "not held"]

_GENERATED = {
    "srv": re.compile(r"_(?:Request|Response|Event)\Z"),
    "action": re.compile(
        r"_(?:Goal|Result|Feedback|FeedbackMessage|(?:SendGoal|GetResult)(?:_(?:Request|Response|Event))?)\Z"
    ),
}
"""Suffixes of the interfaces that ROS 2 generates from services and actions, and that exist as soon as these do."""


@dataclass(frozen=True, slots=True)
class Field:
    """A field of an interface. `type` is the full one: `float64`, `string<=10`, `geometry_msgs/msg/Pose`; `array` is
    empty, `[]`, `[9]` or `[<=9]`.
    """

    name: str
    type: str
    array: str = ""


@dataclass(frozen=True, slots=True)
class Interface:
    """A message (one part), service (request, response) or action (goal, result, feedback) with its full name."""

    name: str
    parts: tuple[tuple[Field, ...], ...]


@dataclass(frozen=True, slots=True)
class Interfaces:
    """All interfaces known for one distribution.

    All names of a package in `complete_packages` are known. Any other package may have names that archgen does not
    know: no name of it is ever wrong. `definitions` reads the shipped data on first use.
    """

    distro: str | None = None
    names: frozenset[str] = frozenset()
    whole: frozenset[str] = frozenset()
    definitions: Mapping[str, Interface] = field(default_factory=dict, compare=False, repr=False)
    project_packages: frozenset[str] = frozenset()
    """Packages that the project defines itself."""
    held: bool = False
    """Whether archgen knows any names for this distribution."""
    mapper: tuple[str, ...] = ()
    """The type names of the shipped type mapper, if it is used: candidates for what an unmapped type may mean."""

    def answer(self, message: str) -> Answer:
        """Return whether `pkg/msg/Name` exists ("known"), does not exist ("wrong"), or is unknown ("not held")."""
        if message in self.names or self._base(message) in self.names:
            return "known"
        return "wrong" if message.split("/", 1)[0] in self.whole else "not held"

    def packages(self) -> frozenset[str]:
        """Return the packages with at least one known interface."""
        return frozenset(name.split("/", 1)[0] for name in self.names)

    def nearest(self, message: str) -> str | None:
        """Return the interface that an unknown name most likely means: one of its package, else its namesake elsewhere.

        A namesake in another package counts if the packages' names are similar, or if it is the only one.
        """
        package, kind, short = message.split("/")
        # A name of the same package outranks a namesake elsewhere, however similar the packages are.
        own = self._by_name((name for name in self.names if name.startswith(f"{package}/")), kind)
        guess = closest(short, own)
        if guess is not None:
            return own[guess]
        same = {name.split("/")[0] for name in self.names if name.endswith(f"/{kind}/{short}")}
        elsewhere = closest(package, same) or (min(same) if len(same) == 1 else None)
        return f"{elsewhere}/{kind}/{short}" if elsewhere else None

    def _base(self, message: str) -> str:
        """Remove the suffix that ROS 2 appends to the names of what it generates from services and actions.

        ROS 1 generates messages with names of their own, which are listed like any others.
        """
        pattern = None if is_ros_1(self.distro) else _GENERATED.get(message.split("/")[1])
        return pattern.sub("", message) if pattern else message

    @staticmethod
    def _by_name(names: Iterable[str], kind: str) -> dict[str, str]:
        """Index full names by their last part; if two kinds share a last part, the wanted kind wins."""
        # Names of the wanted kind are sorted to the end: the last one written stays.
        found = dict[str, str]()
        for name in sorted(names, key=lambda name: (name.split("/")[1] == kind, name)):
            found[name.rsplit("/", 1)[1]] = name
        return found
