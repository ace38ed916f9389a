"""Tests of the quicker dataclasses: they do what those of the standard library do."""

from __future__ import annotations

import copy
import dataclasses
import importlib
import inspect
import pickle
import typing
from dataclasses import field
from typing import Any, ClassVar

import pytest

from archgen.frozen import NamedTuple, dataclass, replace
from tests.running import ROOT


@dataclass(frozen=True, slots=True)
class Place:
    """Three fields, of which one is no part of what it is."""

    file: str
    line: int = 1
    words: list[str] = field(default_factory=list, compare=False)
    at: int = field(kw_only=True, default=0, repr=False)


@dataclass(frozen=True, slots=True)
class Sum:
    """A field that is worked out."""

    parts: tuple[int, ...]
    total: int = field(init=False)

    def __post_init__(self) -> None:
        """Add up."""
        object.__setattr__(self, "total", sum(self.parts))


@dataclass(frozen=True, slots=True)
class Named:
    """One with words of its own."""

    name: str

    def __repr__(self) -> str:
        """Say the name alone."""
        return self.name


@dataclass(slots=True)
class Open:
    """One that may change."""

    count: int = 0


def test_fields_defaults_and_keywords() -> None:
    place = Place("a", at=3)
    assert (place.file, place.line, place.words, place.at) == ("a", 1, [], 3)
    assert Place("a").words is not place.words
    assert repr(Place("a", 2, ["x"])) == "Place(file='a', line=2, words=['x'])"
    assert not hasattr(place, "__dict__")
    assert [one.name for one in dataclasses.fields(place)] == ["file", "line", "words", "at"]
    assert dataclasses.replace(place, line=5) == Place("a", 5, at=3)
    with pytest.raises(TypeError, match=r"missing 1 required positional argument: 'file'"):
        Place()  # type: ignore[call-arg]


def test_equality_and_hash_go_by_what_is_compared() -> None:
    assert Place("a", 1, ["x"]) == Place("a", 1, ["y"])
    assert hash(Place("a", 1, ["x"])) == hash(Place("a", 1, ["y"]))
    assert Place("a") != Place("b")
    assert Named("a") != Place("a")
    assert len({Place("a"), Place("a"), Place("a", at=1)}) == 2


def test_nothing_can_be_changed() -> None:
    place = Place("a")
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'line'"):
        place.line = 2  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'line'"):
        del place.line
    still_open = Open()
    still_open.count = 2
    assert still_open == Open(2)


def test_what_the_class_says_itself_stays() -> None:
    assert repr(Named("b")) == "b"
    assert Sum((1, 2)).total == 3


def test_copies_and_pickles() -> None:
    place = Place("a", 2, ["x"], at=4)
    for other in (copy.deepcopy(place), pickle.loads(pickle.dumps(place))):  # noqa: S301 - our own
        assert other == place
        assert other.words == ["x"]


@dataclass(frozen=True, slots=True)
class Wide:
    """So many fields that `__init__` fills an object of a second class."""

    one: int
    two: str = "b"
    three: tuple[int, ...] = ()
    four: list[str] = field(default_factory=list)
    five: bool = False
    six: str = field(default="f", kw_only=True)


def test_objects_of_many_fields_are_frozen_and_of_their_own_class() -> None:
    wide = Wide(1, six="g")
    assert type(wide) is Wide
    assert (wide.one, wide.two, wide.three, wide.four, wide.five, wide.six) == (1, "b", (), [], False, "g")
    assert repr(wide) == "Wide(one=1, two='b', three=(), four=[], five=False, six='g')"
    with pytest.raises(dataclasses.FrozenInstanceError):
        wide.one = 2  # type: ignore[misc]
    assert type(dataclasses.replace(wide, one=2)) is Wide
    assert pickle.loads(pickle.dumps(wide)) == copy.deepcopy(wide) == wide  # noqa: S301 - our own


@pytest.mark.parametrize(
    ("instance", "changes"),
    [
        (Place("a", 2, ["x"], at=3), {"line": 5, "at": 7}),
        (Place("a", 2, ["x"], at=3), {}),
        (Sum((1, 2)), {"parts": (3, 4)}),
        (Named("a"), {"name": "b"}),
        (Open(1), {"count": 2}),
    ],
)
def test_a_copy_is_that_of_the_standard_library(instance: Any, changes: dict[str, object]) -> None:  # noqa: ANN401
    quick, usual = replace(instance, **changes), dataclasses.replace(instance, **changes)
    assert type(quick) is type(usual)
    names = [field.name for field in dataclasses.fields(usual)]
    assert [getattr(quick, name) for name in names] == [getattr(usual, name) for name in names]
    assert quick is not instance


def test_a_copy_is_frozen_as_well() -> None:
    place = replace(Place("a"), line=2)
    with pytest.raises(dataclasses.FrozenInstanceError):
        place.line = 3  # type: ignore[misc]


def test_a_copy_has_no_field_that_its_class_lacks() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'column'"):
        replace(Place("a"), column=2)  # type: ignore[call-arg]


@dataclass(frozen=True, slots=True)
class Size:
    """One of a shape that `Offset` has as well."""

    width: int
    height: int = 1
    marks: list[str] = field(default_factory=list)
    unit: str = field(default="m", kw_only=True)


@dataclass(frozen=True, slots=True)
class Offset:
    """One whose names are those of other fields of the shape."""

    height: int
    width: int = 2
    labels: set[str] = field(default_factory=set)
    field_0: str = field(default="n", kw_only=True)


def test_classes_of_one_shape_keep_their_own_names_and_defaults() -> None:
    assert Size.__init__.__code__.co_code == Offset.__init__.__code__.co_code
    assert repr(Size(3)) == "Size(width=3, height=1, marks=[], unit='m')"
    assert repr(Offset(3)) == "Offset(height=3, width=2, labels=set(), field_0='n')"
    assert repr(Offset(width=5, height=4, field_0="k")) == "Offset(height=4, width=5, labels=set(), field_0='k')"
    assert str(inspect.signature(Named)) == "(name)"
    with pytest.raises(TypeError, match="unexpected keyword argument 'unit'"):
        Offset(1, unit="m")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"missing 1 required positional argument: 'height'"):
        Offset()  # type: ignore[call-arg]


def test_a_field_without_a_default_stands_before_those_that_have_one() -> None:
    class Wrong:
        """One that nobody could make by position."""

        first: int = 1
        second: int

    with pytest.raises(TypeError, match="Wrong: a field without a default follows one that has one"):
        dataclass(frozen=True, slots=True)(Wrong)


@dataclass(slots=True, eq=False)
class Counter:
    """One that may change, is equal to itself alone, and shares a value with all of its kind."""

    limit: ClassVar[int] = 3
    name: str
    seen: list[str] = field(default_factory=list)
    at: int = 0


def test_a_class_that_may_change_is_that_of_the_standard_library() -> None:
    counter = Counter("a")
    assert (counter.seen, counter.at, Counter.limit) == ([], 0, 3)
    assert Counter("a").seen is not counter.seen
    assert counter != Counter("a")
    assert hash(counter) != hash(Counter("a"))
    counter.at += 1
    assert repr(counter) == "Counter(name='a', seen=[], at=1)"
    assert repr(replace(counter, name="b")) == "Counter(name='b', seen=[], at=1)"
    assert not hasattr(counter, "__dict__")
    with pytest.raises(TypeError, match="unhashable"):
        hash(Open(1))
    assert pickle.loads(pickle.dumps(Open(2))) == Open(2)  # noqa: S301 - our own
    assert [each.name for each in dataclasses.fields(Counter)] == ["name", "seen", "at"]


def test_what_the_standard_library_says_of_a_class_is_made_when_it_is_asked_for() -> None:
    @dataclass(frozen=True, slots=True)
    class Fresh:
        """One that nobody asked for its fields yet."""

        name: str
        words: list[str] = field(default_factory=list, metadata={"unit": "m"})

    assert not isinstance(Fresh.__dict__["__dataclass_fields__"], dict)
    assert dataclasses.is_dataclass(Fresh)
    assert dataclasses.asdict(Fresh("a")) == {"name": "a", "words": []}
    assert dataclasses.fields(Fresh("b"))[1].metadata == {"unit": "m"}
    assert isinstance(Fresh.__dict__["__dataclass_fields__"], dict)
    assert Fresh.__match_args__ == ("name", "words")  # type: ignore[attr-defined]


def test_fields_are_not_inherited() -> None:
    class Derived(Open):
        """One that would have the fields of another one."""

        more: int = 1

    with pytest.raises(TypeError, match="Derived: a class with slots inherits no fields"):
        dataclass(frozen=True, slots=True)(Derived)


class Point(NamedTuple):
    """A named tuple of ours."""

    x: int
    y: int = 2
    words: tuple[str, ...] = ()

    @property
    def total(self) -> int:
        """Their sum."""
        return self.x + self.y


class UsualPoint(typing.NamedTuple):
    """The same of the standard library."""

    x: int
    y: int = 2
    words: tuple[str, ...] = ()


def test_a_named_tuple_is_that_of_the_standard_library() -> None:
    point, usual = Point(1, words=("a",)), UsualPoint(1, words=("a",))
    assert point == usual == (1, 2, ("a",))
    assert (point.x, point.y, point.words, point.total) == (1, 2, ("a",), 3)
    assert repr(point) == repr(usual).removeprefix("Usual")
    assert point._asdict() == usual._asdict()
    assert point._replace(y=5) == usual._replace(y=5)
    assert type(point._replace(y=5)) is Point
    assert (Point._fields, Point._field_defaults) == (UsualPoint._fields, UsualPoint._field_defaults)
    assert Point._make([1, 2, ()]) == UsualPoint._make([1, 2, ()])
    assert type(pickle.loads(pickle.dumps(point))) is type(copy.deepcopy(point)) is Point  # noqa: S301 - our own
    assert str(inspect.signature(Point)) == "(x, y=2, words=())"
    assert type(Point) is type
    assert not hasattr(point, "__dict__")
    match point:
        case Point(x, y):
            assert (x, y) == (1, 2)
    with pytest.raises(TypeError):
        Point()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="Point has no fields"):
        point._replace(z=1)  # type: ignore[call-arg]
    with pytest.raises(AttributeError):
        point.x = 3  # type: ignore[misc]


def test_all_classes_of_the_package_are_dataclasses_to_the_standard_library() -> None:
    """What it would refuse when a class is made, such as a list as a default, is refused here."""
    for path in sorted((ROOT / "archgen").rglob("*.py")):
        name = path.relative_to(ROOT).with_suffix("").as_posix().replace("/", ".").removesuffix(".__init__")
        if "assets" in path.parts or "frozen" not in path.read_text(encoding="utf-8"):
            continue
        for each in vars(importlib.import_module(name)).values():
            if isinstance(each, type) and each.__module__ == name and dataclasses.is_dataclass(each):
                names = [one.name for one in dataclasses.fields(each)]
                assert list(getattr(each, "__slots__", names)) == names
