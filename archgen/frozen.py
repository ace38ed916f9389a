"""Frozen dataclasses with slots whose classes are made in a third of the time, and their objects in two thirds.

Until Python 3.13 the standard library compiles six methods for each class on import: with a hundred classes that was a
quarter of a short run. Here only `__init__` is compiled, and fills the slots directly; the other methods are shared.
To type checkers, and in everything that the project relies on (`fields`, `replace`, equality, hashes, pickles), it is
`dataclasses.dataclass`. Measurements and rejected ways: docs/decisions/0004-frozen.md. Once Python 3.13 is the oldest
supported version, measure again: this file may then go.
"""

from __future__ import annotations

import dataclasses
from operator import attrgetter
from typing import TYPE_CHECKING, Any

__all__ = ["dataclass"]

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from dataclasses import dataclass
else:

    def dataclass(*, frozen: bool = False, slots: bool = False) -> Callable[[type], type]:
        """Return a class decorator; unless both frozen and slotted, the class is made by the standard library."""
        return _frozen if frozen and slots else dataclasses.dataclass(frozen=frozen, slots=slots)


_ABSENT: Any = object()


def _frozen(cls: type) -> type:
    """Make a frozen dataclass with slots. Methods that the class defines itself are kept."""
    # With `slots=True` the standard library returns a new class: `cls` is only looked at for its own methods.
    made: type = dataclasses.dataclass(init=False, repr=False, eq=False, slots=True)(cls)
    fields = dataclasses.fields(made)
    compared = [field.name for field in fields if field.compare]
    methods = {
        "__init__": _init(made, fields),
        "__repr__": _repr([field.name for field in fields if field.repr]),
        **_equality(attrgetter(*compared) if compared else lambda _: ()),
        "__setattr__": _set,
        "__delattr__": _delete,
        # Without these, unpickling would assign the slots and fail in `__setattr__`.
        "__getstate__": _state,
        "__setstate__": _restore,
    }
    for name, method in methods.items():
        if name not in cls.__dict__:
            setattr(made, name, method)
    return made


def _init(made: type, fields: tuple[dataclasses.Field[Any], ...]) -> Any:  # noqa: ANN401 - a method of any class
    """Compile `__init__`, with the signature that the standard library would give it."""
    # The slots' own setters are called directly: they bypass the frozen `__setattr__`, and unlike `object.__setattr__`,
    # which the standard library's frozen classes call, they need not look up the slot by its name.
    names: dict[str, Any] = {"absent": _ABSENT}
    positional, keywords, body = ["self"], ["*"], []
    for field in fields:
        names[f"set_{field.name}"] = made.__dict__[field.name].__set__
        if not field.init:
            continue
        default, value = "", field.name
        if field.default is not dataclasses.MISSING:
            names[f"default_{field.name}"], default = field.default, f"=default_{field.name}"
        elif field.default_factory is not dataclasses.MISSING:
            names[f"make_{field.name}"], default = field.default_factory, "=absent"
            value = f"make_{field.name}() if {field.name} is absent else {field.name}"
        (keywords if field.kw_only else positional).append(field.name + default)
        body.append(f" set_{field.name}(self, {value})")
    if hasattr(made, "__post_init__"):
        body.append(" self.__post_init__()")
    parameters = ", ".join(positional + (keywords if len(keywords) > 1 else []))
    exec(f"def __init__({parameters}):\n" + "\n".join(body or [" pass"]), names)  # noqa: S102 - of field names only
    return names["__init__"]


def _repr(shown: list[str]) -> Callable[[Any], str]:
    """Make a `__repr__` that shows these fields."""

    def text(self: Any) -> str:  # noqa: ANN401
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"

    return text


def _equality(compared: Callable[[Any], object]) -> dict[str, Callable[..., object]]:
    """Make `__eq__` and `__hash__` of the compared values; objects of different classes are never equal."""

    def same(self: object, other: object) -> object:
        return compared(self) == compared(other) if other.__class__ is self.__class__ else NotImplemented

    def number(self: object) -> int:
        return hash(compared(self))

    return {"__eq__": same, "__hash__": number}


def _set(self: object, name: str, value: object) -> None:  # noqa: ARG001 - Python's signature
    message = f"cannot assign to field {name!r}"
    raise dataclasses.FrozenInstanceError(message)


def _delete(self: object, name: str) -> None:  # noqa: ARG001 - the same
    message = f"cannot delete field {name!r}"
    raise dataclasses.FrozenInstanceError(message)


def _values(self: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    return ((field.name, getattr(self, field.name)) for field in dataclasses.fields(self))


def _state(self: Any) -> dict[str, Any]:  # noqa: ANN401
    return dict(_values(self))


def _restore(self: object, state: dict[str, Any]) -> None:
    for name, value in state.items():
        object.__setattr__(self, name, value)
