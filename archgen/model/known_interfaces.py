"""Which ROS interfaces (messages, services, actions) exist, as far as archgen knows.

What the fields of a message say of the values in it: their units, and what a single number can hold.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Literal

from archgen.diagnostics import count_slips, find_closest
from archgen.frozen import NamedTuple, dataclass, field
from archgen.model.ros_distro import PAST_DISTROS, is_ros_1

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
_SPELLED_SEPARATOR = re.compile(r"/|::|\.")
"""What stands between the parts of a message's name: in ROS, in C++, in Python."""
_FULL_NAME_PARTS = 3
_MAX_NAME_SLIPS = 2
"""The slips after which a name of a package that is not held whole is still taken for another one of it."""
_SURE_STEM_LENGTH = 5
"""The letters of a package's name, without `_msgs`, from which on one wrong letter is a slip: `car_msgs` may be a package
of somebody's own, `geometri_msgs` hardly (and `tensor_msgs` exists, so that the first letter has to be right).
"""


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
    project's own definitions give them. `introduction` is what of `comment` stands above the field `header`.
    """

    name: str
    parts: tuple[tuple[InterfaceField, ...], ...]
    constants: tuple[tuple[InterfaceConstant, ...], ...] = ()
    comment: str = ""
    introduction: str = ""

    @property
    def part_names(self) -> tuple[str, ...]:
        """The names of the parts; that of a message's only part is empty."""
        return PART_NAMES[self.name.split("/")[1]]


@dataclass(frozen=True, slots=True)
class Interfaces:
    """All interfaces known for one distribution.

    All names of a package in `complete_packages` are known. Any other package may have names that archgen does not
    know: of a package in `patch_packages`, which is held as of an earlier patch release, only slips are wrong, and of the
    others nothing is. `definitions` and `holding_distros` read the shipped data on first use.
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
    patch_packages: frozenset[str] = frozenset()
    holding_distros: Mapping[str, tuple[str, ...]] = field(default_factory=dict, compare=False, repr=False)
    """The distributions that have an interface, by full name: a name that is missing here may be right elsewhere."""

    def status_of(self, message: str) -> InterfaceStatus:
        """Return whether `pkg/msg/Name` exists ("known"), does not exist ("wrong"), or is unknown ("not held")."""
        if message in self.names or self._base_name(message) in self.names:
            return "known"
        is_wrong = message.split("/", 1)[0] in self.complete_packages or self.find_slip(message) is not None
        return "wrong" if is_wrong else "not held"

    def find_slip(self, message: str) -> str | None:
        """Return the interface that an unknown name is certainly a slip of, None if there is none.

        A name that some distribution has is no slip: it may have come to this one since.
        """
        package, kind, short = message.split("/")
        if message in self.holding_distros:
            return None
        if package in self.complete_packages | self.patch_packages:
            return self.find_other_kind(message) or self._find_near_name(package, kind, short)
        if package in self.known_packages() or self.distro is None:
            return None
        namesake_packages = _index_packages(self.names).get(f"{kind}/{short}", ())
        slips = (name for name in namesake_packages if _is_package_slip(package, name))
        return next((f"{name}/{kind}/{short}" for name in slips), None)

    def read_message(self, text: str) -> str | None:
        """Return the message that a text in another spelling means, such as `nav_msgs::msg::Odometry` or `std_msgs/string`.

        None if it is a known message as it stands, or means none for certain.
        """
        parts = _SPELLED_SEPARATOR.split(text)
        package, kind, short = parts if len(parts) == _FULL_NAME_PARTS else (parts[0], "msg", parts[-1])
        if not 1 < len(parts) <= _FULL_NAME_PARTS or kind not in {"msg", "srv", "action"} or not short:
            return None
        message = f"{package}/{kind}/{short}"
        return message if message in self.names else self.find_slip(message)

    def find_other_kind(self, message: str) -> str | None:
        """Return the interface of this name, but of another kind: `nav_msgs/srv/GetPlan` for `nav_msgs/msg/GetPlan`.

        ROS 1 writes actions as messages: `MoveBaseAction` is the action `MoveBase`.
        """
        package, kind, short = message.split("/")
        other_kinds = {
            "srv": f"{package}/srv/{short}",
            "msg": f"{package}/msg/{short}",
            "action": f"{package}/action/{short.removesuffix('Action') or short}",
        }
        return next((name for other, name in other_kinds.items() if other != kind and name in self.names), None)

    def _find_near_name(self, package: str, kind: str, short: str) -> str | None:
        package_names = _index_names(self.names, package, kind)
        guess = find_closest(short, package_names)
        is_slip = guess is not None and count_slips(short, guess) <= _MAX_NAME_SLIPS
        return package_names[guess] if guess is not None and is_slip else None

    def known_packages(self) -> frozenset[str]:
        """Return the packages with at least one known interface."""
        return _list_packages(self.names)

    def find_nearest(self, message: str) -> str | None:
        """Return the interface that an unknown name most likely means: one of its package, else its namesake elsewhere.

        A namesake in another package counts if the packages' names are similar, or if it is the only one.
        """
        other_kind = self.find_other_kind(message)
        if other_kind is not None:
            return other_kind
        package, kind, short = message.split("/")
        # A name of the same package outranks a namesake elsewhere, however similar the packages are.
        package_names = _index_names(self.names, package, kind)
        guess = find_closest(short, package_names)
        if guess is not None:
            return package_names[guess]
        namesake_packages = _index_packages(self.names).get(f"{kind}/{short}", ())
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


# Cached by the set of names, which a project has one of: a hostile one may ask for tens of thousands of names.
@lru_cache(8)
def _list_packages(names: frozenset[str]) -> frozenset[str]:
    return frozenset(name.split("/", 1)[0] for name in names)


@lru_cache(8)
def _index_packages(names: frozenset[str]) -> Mapping[str, tuple[str, ...]]:
    """Return the packages that have an interface, sorted, by the rest of its name (`msg/Image`)."""
    packages = dict[str, tuple[str, ...]]()
    for name in sorted(names):
        package, _, rest = name.partition("/")
        packages[rest] = (*packages.get(rest, ()), package)
    return packages


@lru_cache(512)
def _index_names(names: frozenset[str], package: str, kind: str) -> Mapping[str, str]:
    """Index the full names of a package by their last part; if two kinds share a last part, the wanted kind wins."""
    # Names of the wanted kind are sorted to the end: the last one written stays.
    package_names = sorted(name for name in names if name.startswith(f"{package}/"))
    return {name.rsplit("/", 1)[1]: name for name in sorted(package_names, key=lambda name: name.split("/")[1] == kind)}


def guess_distro(distro: str | None) -> str | None:
    """Return the distribution that a project means: what it writes, or what that is a slip of (`jazzy` for `jazy`).

    Messages are checked against the guess, so that a slip in one word does not keep all others unseen.
    """
    if distro is None or distro in KNOWN_DISTROS or distro in PAST_DISTROS:
        return distro
    return find_closest(distro, KNOWN_DISTROS) or distro


def _is_package_slip(package: str, name: str) -> bool:
    """Whether an unknown package is certainly a slip of a known one: `nav_msg`, `sdt_msgs` or `sensors_msgs`.

    Of the 6,134 packages of eleven distributions none is taken for one that is held and has the same message.
    """
    slips = count_slips(package, name)
    stem, known_stem = package.rpartition("_")[0], name.rpartition("_")[0]
    if stem and stem == known_stem:
        return slips <= _MAX_NAME_SLIPS
    is_long = len(known_stem) >= _SURE_STEM_LENGTH and package[:1] == name[:1]
    return slips == 0 or (slips == 1 and (is_long or sorted(package) == sorted(name)))


_UNIT = re.compile(r"\[([^\[\]\s]{1,30})\]")
"""A unit at the beginning of a field's comment: `[m/s] Positive to the left.`"""
_INTEGERS = {f"{sign}int{bits}": (sign, bits) for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS = frozenset({*_INTEGERS, "byte", "float32", "float64"})
_MAX_MESSAGES = 200


class CarriedNumber(NamedTuple):
    """A whole number in a message, by the field's name, with what its type can hold."""

    name: str
    type: str
    least: int
    greatest: int


def list_units(interfaces: Interfaces, message: str | None) -> tuple[str, ...]:
    """Return the units that the fields of a message say, to any depth, sorted; none where nobody says one."""
    units = {
        match[1] for field in _list_fields(interfaces, message) if (match := _UNIT.match(field.comment)) is not None
    }
    return tuple(sorted(units))


def find_only_number(interfaces: Interfaces, message: str | None) -> CarriedNumber | None:
    """Return the only number in a message, if it is a single whole one: of others nobody knows which one is meant."""
    fields = [field for field in _list_fields(interfaces, message) if field.type in _NUMBERS]
    if len(fields) != 1 or fields[0].array or fields[0].type not in _INTEGERS:
        return None
    sign, bits = _INTEGERS[fields[0].type]
    least, greatest = (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return CarriedNumber(fields[0].name, fields[0].type, least, greatest)


def _list_fields(interfaces: Interfaces, message: str | None) -> Iterator[InterfaceField]:
    """Yield the fields of a message and of all messages in it, each message once."""
    waiting, seen = [message] if message else [], set[str]()
    while waiting and len(seen) < _MAX_MESSAGES:
        name = waiting.pop()
        definition = interfaces.definitions.get(name)
        if name in seen or definition is None:
            continue
        seen.add(name)
        for part in definition.parts:
            for each in part:
                yield each
                if "/" in each.type:
                    waiting.append(each.type)
