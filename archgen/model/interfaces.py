"""Which ROS interfaces exist: what archgen knows of messages, services and actions, and what it does not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

Answer = Literal["known", "wrong", "not held"]


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
    """All interfaces known for one distribution. Packages in `whole` are held with all their names."""

    distro: str | None = None
    names: frozenset[str] = frozenset()
    whole: frozenset[str] = frozenset()
    definitions: Mapping[str, Interface] = field(default_factory=dict)
    project_packages: frozenset[str] = frozenset()
    """Packages that the project defines itself."""

    def answer(self, message: str) -> Answer:
        """Say whether `pkg/msg/Name` exists, does not exist, or cannot be told."""
        if message in self.names:
            return "known"
        return "wrong" if message.split("/", 1)[0] in self.whole else "not held"
