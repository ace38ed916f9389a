"""Frozen dataclasses with slots whose classes are made in a third of the time, and their objects in a third to two thirds.

Until Python 3.13 the standard library compiles six methods for each class on import: with a hundred classes that was a
quarter of a short run. Here only `__init__` is compiled, once for all classes of one shape, and fills the slots directly;
the other methods are shared.
To type checkers, and in everything that the project relies on (`fields`, `replace`, equality, hashes, pickles), it is
`dataclasses.dataclass`. Measurements and rejected ways: docs/decisions/0004-frozen.md. Once Python 3.13 is the oldest
supported version, measure again: this file may then go.
"""

from __future__ import annotations

import dataclasses
from functools import cache
from operator import attrgetter
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

__all__ = ["dataclass", "replace"]

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from dataclasses import dataclass, replace
else:

    def dataclass(*, frozen: bool = False, slots: bool = False) -> Callable[[type], type]:
        """Return a class decorator; unless both frozen and slotted, the class is made by the standard library."""
        return _make_frozen if frozen and slots else dataclasses.dataclass(frozen=frozen, slots=slots)

    def replace(instance: Any, /, **changes: Any) -> Any:  # noqa: ANN401 - any dataclass
        """Return a copy with other values in some fields, as `dataclasses.replace` does, in a fifth of the time."""
        copier = _COPIERS.get(instance.__class__)
        if copier is None:
            copier = _COPIERS[instance.__class__] = _make_copier(instance.__class__)
        copy_fields, setters = copier
        # What has no quick way, or no such field, is left to the standard library, which says what is wrong.
        if copy_fields is None:
            return dataclasses.replace(instance, **changes)
        copy = copy_fields(instance)
        for name, value in changes.items():
            if name not in setters:
                return dataclasses.replace(instance, **changes)
            setters[name](copy, value)
        return copy


_NO_VALUE: Any = object()
_NOTHING: Mapping[Any, Any] = {}
"""What all fields of type `Mapping` share that are empty unless given: nobody may write to them, and models have a million."""


def _make_frozen(cls: type) -> type:
    """Make a frozen dataclass with slots. Methods that the class defines itself are kept."""
    # With `slots=True` the standard library returns a new class: `cls` is only looked at for its own methods.
    frozen_class: type = dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    fields = dataclasses.fields(frozen_class)
    compared_names = [field.name for field in fields if field.compare]
    methods = {
        "__init__": _make_init(frozen_class, fields),
        "__repr__": _make_repr([field.name for field in fields if field.repr]),
        **_make_equality(attrgetter(*compared_names) if compared_names else lambda _: ()),
        "__setattr__": _refuse_assignment,
        "__delattr__": _refuse_deletion,
        # Without these, unpickling would assign the slots and fail in `__setattr__`.
        "__getstate__": _get_state,
        "__setstate__": _set_state,
    }
    for name, method in methods.items():
        if name not in cls.__dict__:
            setattr(frozen_class, name, method)
    return frozen_class


def _make_init(frozen_class: type, fields: tuple[dataclasses.Field[Any], ...]) -> Any:  # noqa: ANN401 - a method of any class
    """Make `__init__`, with the signature that the standard library would give it.

    Classes of the same shape share what was compiled, with other names: to compile takes ten times as long.
    """
    open_class = _make_open_class(frozen_class) if len(fields) >= _MIN_OPEN_FIELDS else None
    given = sorted((field for field in fields if field.init), key=attrgetter("kw_only"))
    namespace: dict[str, Any] = {"absent": _NO_VALUE, "open_class": open_class, "frozen_class": frozen_class}
    namespace["set_class"] = _SET_CLASS
    defaults: dict[str, Any] = {}
    made_places: list[int] = []
    for at, field in enumerate(given):
        # The slots' own setters are called directly: they bypass the frozen `__setattr__`, and unlike
        # `object.__setattr__`, which the standard library's frozen classes call, need not look up the slot by its name.
        namespace[f"set_{at}"] = frozen_class.__dict__[field.name].__set__
        if field.default is not dataclasses.MISSING:
            defaults[field.name] = field.default
        elif field.default_factory is dict and str(field.type).startswith("Mapping["):
            defaults[field.name] = _NOTHING
        elif field.default_factory is not dataclasses.MISSING:
            namespace[f"make_{at}"], defaults[field.name] = field.default_factory, _NO_VALUE
            made_places.append(at)
    positional = [field.name for field in given if not field.kw_only]
    late_names = [name for name in positional if name in defaults]
    if late_names != positional[len(positional) - len(late_names) :]:
        message = f"{frozen_class.__name__}: a field without a default follows one that has one"
        raise TypeError(message)
    has_end = hasattr(frozen_class, "__post_init__")
    code = _compile_init(
        len(positional), len(given), tuple(made_places), is_open=open_class is not None, has_end=has_end
    )
    names = {f"field_{at}": field.name for at, field in enumerate(given)}
    code = code.replace(
        co_varnames=tuple([names.get(name, name) for name in code.co_varnames]),
        co_names=tuple([names.get(name, name) for name in code.co_names]),
    )
    init = FunctionType(code, namespace, "__init__", tuple([defaults.pop(name) for name in late_names]))
    init.__kwdefaults__ = defaults
    return init


@cache
def _compile_init(
    positional_count: int, count: int, made_places: tuple[int, ...], *, is_open: bool, has_end: bool
) -> CodeType:
    """Compile an `__init__` of fields that are called `field_0`, `field_1`, ...; some are made unless they are given."""
    names = [f"field_{at}" for at in range(count)]
    values = [
        f"make_{at}() if {name} is absent else {name}" if at in made_places else name for at, name in enumerate(names)
    ]
    if is_open:
        body = [f" self.{name} = {value}" for name, value in zip(names, values, strict=True)]
        body = [" set_class(self, open_class)", *body, " set_class(self, frozen_class)"]
    else:
        body = [f" set_{at}(self, {value})" for at, value in enumerate(values)]
    if has_end:
        body.append(" self.__post_init__()")
    keywords = ["*", *names[positional_count:]] if count > positional_count else []
    parameters = ", ".join(["self", *names[:positional_count], *keywords])
    namespace: dict[str, Any] = {}
    exec(f"def __init__({parameters}):\n" + "\n".join(body or [" pass"]), namespace)  # noqa: S102 - of numbers only
    code: CodeType = namespace["__init__"].__code__
    return code


_SET_CLASS: Any = object.__dict__["__class__"].__set__
_MIN_OPEN_FIELDS = 5
"""From so many fields on it pays to make a second class, and to change an object's class twice."""


def _make_open_class(frozen_class: type) -> type | None:
    """Make a class with the same slots whose objects may be assigned to, for `__init__`; None where the bases forbid it.

    Python assigns to slots of an ordinary class in a tenth of the time that a call of a slot's setter takes.
    """
    if frozen_class.__bases__ != (object,) or type(frozen_class) is not type:
        return None
    return type(frozen_class.__name__, (), {"__slots__": frozen_class.__slots__})  # type: ignore[attr-defined]


_COPIERS: dict[type, tuple[Callable[[Any], Any] | None, Mapping[str, Callable[[Any, Any], None]]]] = {}
"""By class: what copies an object's fields, None where the standard library must do it, and what sets each of them."""


def _make_copier(cls: type) -> tuple[Callable[[Any], Any] | None, dict[str, Callable[[Any, Any], None]]]:
    """Make what `replace` needs of a class; nothing where a new object is more than its fields."""
    fields = dataclasses.fields(cls)
    is_plain = "__slots__" in cls.__dict__ and cls.__dict__.get("__setattr__") is _refuse_assignment
    open_class = _make_open_class(cls) if is_plain else None
    if open_class is None or hasattr(cls, "__post_init__") or not all(field.init for field in fields):
        return None, {}
    names = [field.name for field in fields]
    namespace: dict[str, Any] = {
        "make": open_class.__new__,
        "set_class": _SET_CLASS,
        "open_class": open_class,
        "cls": cls,
    }
    lines = ["def copy_fields(self):", " copy = make(open_class)", *(f" copy.{name} = self.{name}" for name in names)]
    exec("\n".join([*lines, " set_class(copy, cls)", " return copy"]), namespace)  # noqa: S102 - of field names only
    return namespace["copy_fields"], {name: cls.__dict__[name].__set__ for name in names}


def _make_repr(field_names: list[str]) -> Callable[[Any], str]:
    """Make a `__repr__` that shows these fields."""
    values = attrgetter(*field_names, "__class__") if field_names else None
    template = f"({', '.join(f'{name}=%r' for name in field_names)})"

    def represent_object(self: Any) -> str:  # noqa: ANN401
        return f"{type(self).__qualname__}{template % values(self)[:-1] if values else '()'}"

    return represent_object


def _make_equality(compared_values: Callable[[Any], object]) -> dict[str, Callable[..., object]]:
    """Make `__eq__` and `__hash__` of the compared values; objects of different classes are never equal."""

    def is_equal(self: object, other: object) -> object:
        return compared_values(self) == compared_values(other) if other.__class__ is self.__class__ else NotImplemented

    def hash_values(self: object) -> int:
        return hash(compared_values(self))

    return {"__eq__": is_equal, "__hash__": hash_values}


def _refuse_assignment(self: object, name: str, value: object) -> None:  # noqa: ARG001 - Python's signature
    message = f"cannot assign to field {name!r}"
    raise dataclasses.FrozenInstanceError(message)


def _refuse_deletion(self: object, name: str) -> None:  # noqa: ARG001 - the same
    message = f"cannot delete field {name!r}"
    raise dataclasses.FrozenInstanceError(message)


def _field_values(self: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    return ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))


def _get_state(self: Any) -> dict[str, Any]:  # noqa: ANN401
    return dict(_field_values(self))


def _set_state(self: object, state: dict[str, Any]) -> None:
    for name, value in state.items():
        object.__setattr__(self, name, value)
