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
from collections import _tuplegetter  # type: ignore[attr-defined]
from dataclasses import field, fields
from functools import cache
from operator import attrgetter
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

__all__ = ["NamedTuple", "dataclass", "field", "fields", "replace"]

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping
    from dataclasses import dataclass, replace
    from typing import NamedTuple
else:

    def dataclass(*, frozen: bool = False, slots: bool = False, eq: bool = True) -> Callable[[type], type]:
        """Return a class decorator; a class without slots is made by the standard library."""
        if not slots:
            return dataclasses.dataclass(frozen=frozen, eq=eq)
        return lambda cls: _make_slotted(cls, frozen=frozen, eq=eq)

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

    class _TupleClasses(type):
        """Makes a named tuple of each class that names `NamedTuple` as its base: of the fields that the class annotates."""

        def __new__(cls, name: str, bases: tuple[type, ...], namespace: dict[str, Any]) -> type:
            """Make it an ordinary class, as quick to call as any other one."""
            if not bases:
                return super().__new__(cls, name, bases, namespace)
            names = tuple(namespace.get("__annotations__", ()))
            defaults = {name: namespace[name] for name in names if name in namespace}
            make = FunctionType(_name_fields(_compile_new(len(names)), names), _TUPLE_MAKING, "__new__")
            make.__defaults__ = tuple(defaults.values())
            getters = {name: _tuplegetter(at, None) for at, name in enumerate(names)}
            own = {
                "__slots__": (),
                "_fields": names,
                "__match_args__": names,
                "_field_defaults": defaults,
                "__new__": make,
            }
            return type(name, (_TupleMethods,), {**namespace, **getters, **own})

    class NamedTuple(metaclass=_TupleClasses):
        """As `typing.NamedTuple`, whose classes are made in a quarter of the time."""


class _TupleMethods(tuple[Any, ...]):
    """What all named tuples share."""

    __slots__ = ()
    _fields: tuple[str, ...]

    @classmethod
    def _make(cls, values: Iterable[Any]) -> Any:  # noqa: ANN401 - a named tuple
        return cls(*values)

    def _replace(self, /, **changes: Any) -> Any:  # noqa: ANN401 - the same
        made = tuple.__new__(self.__class__, map(changes.pop, self._fields, self))
        if changes:
            raise TypeError(f"{self.__class__.__name__} has no fields {[*changes]}")
        return made

    def _asdict(self) -> dict[str, Any]:
        return dict(zip(self._fields, self, strict=True))

    def __repr__(self) -> str:
        words = ", ".join([f"{name}={value!r}" for name, value in zip(self._fields, self, strict=True)])
        return f"{self.__class__.__name__}({words})"

    def __getnewargs__(self) -> tuple[Any, ...]:
        return tuple(self)


_TUPLE_MAKING = {"make_tuple": tuple.__new__}


@cache
def _compile_new(count: int) -> CodeType:
    """Compile a `__new__` of fields that are called `field_0`, `field_1`, ..."""
    names = "".join([f"field_{at}, " for at in range(count)])
    code: CodeType = eval(f"lambda cls, {names}: make_tuple(cls, ({names}))", _TUPLE_MAKING).__code__  # noqa: S307 - of a number only
    return code


def _name_fields(code: CodeType, field_names: Iterable[str]) -> CodeType:
    """Call the fields of a compiled method by their names."""
    names = {f"field_{at}": name for at, name in enumerate(field_names)}
    return code.replace(
        co_varnames=tuple([names.get(name, name) for name in code.co_varnames]),
        co_names=tuple([names.get(name, name) for name in code.co_names]),
    )


_NO_VALUE: Any = object()
_NOTHING: Mapping[Any, Any] = {}
"""What all fields of type `Mapping` share that are empty unless given: nobody may write to them, and models have a million."""
_PLAIN_FIELD: dataclasses.Field[Any] = dataclasses.field()


def _make_slotted(cls: type, *, frozen: bool, eq: bool) -> type:
    """Make a dataclass with slots. Methods that the class defines itself are kept."""
    if any("__dataclass_fields__" in base.__dict__ for base in cls.__mro__[1:]):
        raise TypeError(f"{cls.__name__}: a class with slots inherits no fields")
    namespace = {name: value for name, value in cls.__dict__.items() if name not in {"__dict__", "__weakref__"}}
    fields = {
        name: _take_field(namespace, name)
        for name, annotation in cls.__annotations__.items()
        if "ClassVar" not in str(annotation)
    }
    compared_names = [name for name, field in fields.items() if field.compare]
    compared_values = attrgetter(*compared_names) if compared_names else lambda _: ()
    slotted_class: type = type(cls)(
        cls.__name__,
        cls.__bases__,
        {
            "__repr__": _make_repr([name for name, field in fields.items() if field.repr]),
            **(_make_equality(compared_values, is_hashable=frozen) if eq else {}),
            **(_FROZEN_METHODS if frozen else {}),
            **namespace,
            "__qualname__": cls.__qualname__,
            "__slots__": tuple(fields),
            "__match_args__": tuple(
                [name for name, field in fields.items() if field.init and field.kw_only is not True]
            ),
            "__dataclass_fields__": _StandardAttribute(cls),
            "__dataclass_params__": _StandardAttribute(cls),
        },
    )
    if "__init__" not in namespace:
        slotted_class.__init__ = _make_init(slotted_class, fields, frozen=frozen)  # type: ignore[misc]
    return slotted_class


def _take_field(namespace: dict[str, Any], name: str) -> dataclasses.Field[Any]:
    """Take what is said of a field from what a class is made of: its slot stands in that place."""
    value = namespace.pop(name, _NO_VALUE)
    if value is _NO_VALUE:
        return _PLAIN_FIELD
    return value if isinstance(value, dataclasses.Field) else dataclasses.field(default=value)


def _is_mapping(annotation: object) -> bool:
    """Whether a field can only be read: a `dict` may be filled later."""
    return str(annotation).startswith("Mapping[")


class _StandardAttribute:
    """What `dataclasses.fields` and its like ask of a class: the standard library makes it once they do, for few classes."""

    def __init__(self, plain_class: type) -> None:
        """Take the class as it was written, without slots."""
        self._plain_class = plain_class

    def __set_name__(self, owner: type, name: str) -> None:
        """Take the class with slots."""
        self._slotted_class, self._name = owner, name

    def __get__(self, instance: object, owner: type) -> object:
        """Return the attribute, which stands in this one's place from now on."""
        if "__dataclass_fields__" not in self._plain_class.__dict__:
            dataclasses.dataclass(init=False, repr=False, eq=False)(self._plain_class)
        value = self._plain_class.__dict__[self._name]
        setattr(self._slotted_class, self._name, value)
        return value


def _make_init(slotted_class: type, fields: Mapping[str, dataclasses.Field[Any]], *, frozen: bool) -> Any:  # noqa: ANN401 - a method of any class
    """Make `__init__`, with the signature that the standard library would give it.

    Classes of the same shape share what was compiled, with other names: to compile takes ten times as long.
    """
    given = {name: field for name, field in fields.items() if field.init and field.kw_only is not True}
    positional = [*given]
    given |= {name: field for name, field in fields.items() if field.init and field.kw_only is True}
    open_class = _make_open_class(slotted_class) if frozen and len(fields) >= _MIN_OPEN_FIELDS else None
    way = "assigned" if not frozen else "set" if open_class is None else "opened"
    namespace: dict[str, Any] = {"absent": _NO_VALUE}
    if open_class is not None:
        namespace |= {"open_class": open_class, "frozen_class": slotted_class, "set_class": _SET_CLASS}
    defaults: dict[str, Any] = {}
    made_places: list[int] = []
    for at, (name, given_field) in enumerate(given.items()):
        if way == "set":
            # The slots' own setters are called directly: they bypass the frozen `__setattr__`, and unlike
            # `object.__setattr__`, which the standard library's frozen classes call, need not look up the slot by its name.
            namespace[f"set_{at}"] = slotted_class.__dict__[name].__set__
        if given_field.default is not dataclasses.MISSING:
            defaults[name] = given_field.default
        elif frozen and given_field.default_factory is dict and _is_mapping(slotted_class.__annotations__[name]):
            defaults[name] = _NOTHING
        elif given_field.default_factory is not dataclasses.MISSING:
            namespace[f"make_{at}"], defaults[name] = given_field.default_factory, _NO_VALUE
            made_places.append(at)
    late_names = [name for name in positional if name in defaults]
    if late_names != positional[len(positional) - len(late_names) :]:
        raise TypeError(f"{slotted_class.__name__}: a field without a default follows one that has one")
    has_end = hasattr(slotted_class, "__post_init__")
    code = _compile_init(len(positional), len(given), tuple(made_places), way=way, has_end=has_end)
    init = FunctionType(
        _name_fields(code, given), namespace, "__init__", tuple([defaults.pop(name) for name in late_names])
    )
    init.__kwdefaults__ = defaults
    return init


@cache
def _compile_init(
    positional_count: int, count: int, made_places: tuple[int, ...], *, way: str, has_end: bool
) -> CodeType:
    """Compile an `__init__` of fields that are called `field_0`, `field_1`, ...; some are made unless they are given."""
    names = [f"field_{at}" for at in range(count)]
    values = [
        f"make_{at}() if {name} is absent else {name}" if at in made_places else name for at, name in enumerate(names)
    ]
    if way == "set":
        body = [f" set_{at}(self, {value})" for at, value in enumerate(values)]
    else:
        body = [f" self.{name} = {value}" for name, value in zip(names, values, strict=True)]
    if way == "opened":
        body = [" set_class(self, open_class)", *body, " set_class(self, frozen_class)"]
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


def _make_equality(
    compared_values: Callable[[Any], object], *, is_hashable: bool
) -> dict[str, Callable[..., object] | None]:
    """Make `__eq__` and `__hash__` of the compared values; objects of different classes are never equal."""

    def is_equal(self: object, other: object) -> object:
        return compared_values(self) == compared_values(other) if other.__class__ is self.__class__ else NotImplemented

    def hash_values(self: object) -> int:
        return hash(compared_values(self))

    return {"__eq__": is_equal, "__hash__": hash_values if is_hashable else None}


def _refuse_assignment(self: object, name: str, value: object) -> None:  # noqa: ARG001 - Python's signature
    raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_deletion(self: object, name: str) -> None:  # noqa: ARG001 - the same
    raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")


def _get_state(self: Any) -> dict[str, Any]:  # noqa: ANN401
    return {name: getattr(self, name) for name in self.__slots__}


def _set_state(self: object, state: dict[str, Any]) -> None:
    for name, value in state.items():
        object.__setattr__(self, name, value)


# Without the last two, unpickling would assign the slots and fail in `__setattr__`.
_FROZEN_METHODS: Mapping[str, Callable[..., Any]] = {
    "__setattr__": _refuse_assignment,
    "__delattr__": _refuse_deletion,
    "__getstate__": _get_state,
    "__setstate__": _set_state,
}
