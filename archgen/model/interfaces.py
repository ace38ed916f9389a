"""Which ROS interfaces exist: what archgen knows of messages, services and actions, and what it does not."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Literal

from archgen.frozen import dataclass
from archgen.model.distro import is_ros_1
from archgen.suggest import closest

DISTROS = ("jazzy", "humble", "kilted", "lyrical", "rolling", "noetic")
"""The distributions of which archgen holds names; where a project names none, the first that has a message gives its
fields.
"""
Answer = Literal["known", "wrong", "not held"]

_GENERATED = {
    "srv": re.compile(r"_(?:Request|Response|Event)\Z"),
    "action": re.compile(
        r"_(?:Goal|Result|Feedback|FeedbackMessage|(?:SendGoal|GetResult)(?:_(?:Request|Response|Event))?)\Z"
    ),
}
"""What ROS 2 makes of services and actions besides: names that exist where the service or the action does."""


@dataclass(frozen=True, slots=True)
class Field:
    """A field of an interface. `type` is as resolved: `float64`, `string<=10`, `geometry_msgs/msg/Pose`; `array` is
    empty, `[]`, `[9]` or `[<=9]`.
    """

    name: str
    type: str
    array: str = ""


@dataclass(frozen=True, slots=True)
class Interface:
    """A message (one part), service (request, response) or action (goal, result, feedback), by its full name."""

    name: str
    parts: tuple[tuple[Field, ...], ...]


@dataclass(frozen=True, slots=True)
class Interfaces:
    """All interfaces known for one distribution. Packages in `whole` are held with all their names.

    Of a package that is not whole nothing is ever wrong: it may have names that archgen does not hold. `definitions`
    read what ships on first use.
    """

    distro: str | None = None
    names: frozenset[str] = frozenset()
    whole: frozenset[str] = frozenset()
    definitions: Mapping[str, Interface] = field(default_factory=dict, compare=False, repr=False)
    project_packages: frozenset[str] = frozenset()
    """Packages that the project defines itself."""
    held: bool = False
    """Whether archgen has any names for this distribution."""
    mapper: tuple[str, ...] = ()
    """The names of the shipped type mapper, where it was asked: what a type that nobody mapped may have meant."""

    def answer(self, message: str) -> Answer:
        """Say whether `pkg/msg/Name` exists, does not exist, or cannot be told."""
        if message in self.names or self._base(message) in self.names:
            return "known"
        return "wrong" if message.split("/", 1)[0] in self.whole else "not held"

    def packages(self) -> frozenset[str]:
        """Name the packages of which at least one interface is known."""
        return frozenset(name.split("/", 1)[0] for name in self.names)

    def nearest(self, message: str) -> str | None:
        """Guess which interface a name that is not known means: one of its package first, else its namesake elsewhere."""
        package, kind, short = message.split("/")
        own = self._by_name((name for name in self.names if name.startswith(f"{package}/")), kind)
        guess = closest(short, own)
        if guess is not None:
            return own[guess]
        same = {name.split("/")[0] for name in self.names if name.endswith(f"/{kind}/{short}")}
        elsewhere = closest(package, same) or (min(same) if len(same) == 1 else None)
        return f"{elsewhere}/{kind}/{short}" if elsewhere else None

    def _base(self, message: str) -> str:
        """Take off what ROS 2 appends to the names of services and actions (ROS 1 makes messages of its own)."""
        pattern = None if is_ros_1(self.distro) else _GENERATED.get(message.split("/")[1])
        return pattern.sub("", message) if pattern else message

    @staticmethod
    def _by_name(names: Iterable[str], kind: str) -> dict[str, str]:
        """Index full names by their last part; where two kinds share one, the wanted kind wins."""
        found = dict[str, str]()
        for name in sorted(names, key=lambda name: (name.split("/")[1] == kind, name)):
            found[name.rsplit("/", 1)[1]] = name
        return found
