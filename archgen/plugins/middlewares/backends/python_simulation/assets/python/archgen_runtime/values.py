"""Values of ports: what they may be, and how they are written and read as JSON."""

import dataclasses
import json
import math
import re

from .errors import SimulationError

_LEAST_WHOLE, _MOST_WHOLE = -(2**63), 2**63 - 1
_MOST_DIGITS = 17
_PLAIN_EXPONENTS = range(-4, 16)
_DEEPEST = 100
_WORDS = {"NaN": math.nan, "Infinity": math.inf, "-Infinity": -math.inf}


class _Token(str):
    """A number as it is written."""

    __slots__ = ()


class Kind:
    """What a value may be."""

    def __init__(self, name, check, read):
        """Take what the kind is called, what checks a value, and what reads one."""
        self.name = name
        self.check = check
        self.read = read


def _expect(value, python_type, name, wanted):
    if type(value) is not python_type:
        raise SimulationError(f"{name} is not {wanted}")
    return value


def _check_whole(value, name):
    _expect(value, int, name, "a whole number")
    if not _LEAST_WHOLE <= value <= _MOST_WHOLE:
        raise SimulationError(f"{name} has no place in 64 bits")
    return value


def _check_number(value, name):
    if type(value) not in (int, float):
        raise SimulationError(f"{name} is not a number")
    return float(value)


def _read_whole(read, name):
    _expect(read, _Token, name, "a whole number")
    if re.fullmatch("-?[0-9]+", read) is None:
        raise SimulationError(f"{name} is not a whole number")
    # More digits than any number of 64 bits has, and than Python converts.
    if len(read) > 20:
        raise SimulationError(f"{name} has no place in 64 bits")
    return _check_whole(int(read), name)


def _read_number(read, name):
    _expect(read, _Token, name, "a number")
    return _WORDS[read] if read in _WORDS else float(read)


_WHOLE = Kind("whole number", _check_whole, _read_whole)
_NUMBER = Kind("number", _check_number, _read_number)
_TRUTH = Kind(
    "truth",
    lambda value, name: _expect(value, bool, name, "true or false"),
    lambda read, name: _expect(read, bool, name, "true or false"),
)
_TEXT = Kind(
    "text",
    lambda value, name: _expect(value, str, name, "a text"),
    lambda read, name: _expect(read, str, name, "a text"),
)


def _refuse(_, __):
    raise SimulationError("a port of several types takes no values of a scenario")


_ANYTHING = Kind("anything", lambda value, _: value, _refuse)


def _make_record_kind(find_class):
    def check(value, name):
        if not isinstance(value, find_class()):
            raise SimulationError(f"{name} is not a {find_class().__name__}")
        return value

    def read(given, name):
        _expect(given, dict, name, "an object")
        fields = {_name_of(each): each for each in dataclasses.fields(find_class())}
        for key in given:
            if key not in fields:
                raise SimulationError(f"{name} has no field {write_value(key)}")
        kinds = {key: fields[key].metadata["kind"] for key in given}
        read = {fields[key].name: kinds[key].read(given[key], key) for key in given}
        return find_class()(**read)

    return Kind("record", check, read)


def _make_list_kind(kind, least, most):
    def check_size(items):
        if len(items) < least or (most is not None and len(items) > most):
            wanted = str(least) if least == most else f"at most {most}"
            raise SimulationError(f"it has {len(items)} items instead of {wanted}")
        return items

    def check(value, name):
        if not isinstance(value, (list, tuple)):
            raise SimulationError(f"{name} is not a list")
        return check_size(tuple(kind.check(each, name) for each in value))

    def read(given, name):
        return tuple(kind.read(each, name) for each in _expect(given, list, name, "a list"))

    return Kind("list", check, read)


def _declare(kind, default, name):
    return dataclasses.field(default=default, metadata={"kind": kind, "name": name})


def whole(default=0, name=None):
    """Declare a whole number of 64 bits.

    `name` is what the model calls the field, if Python calls it otherwise.
    """
    return _declare(_WHOLE, default, name)


def number(default=0.0, name=None):
    """Declare a number."""
    return _declare(_NUMBER, default, name)


def truth(default=False, name=None):
    """Declare what is true or false."""
    return _declare(_TRUTH, default, name)


def text(default="", name=None):
    """Declare a text."""
    return _declare(_TEXT, default, name)


def record(find_class, name=None):
    """Declare another message; `find_class` returns its class."""
    return dataclasses.field(
        default_factory=lambda: find_class()(),  # noqa: PLW0108 - the class is not there yet
        metadata={"kind": _make_record_kind(find_class), "name": name},
    )


def items(declared, default=None, least=0, most=None, name=None):
    """Declare a list of what is declared, of `least` to `most` items."""
    kind = _make_list_kind(declared.metadata["kind"], least, most)

    def make_default():
        if default is not None:
            return default
        if declared.default is not dataclasses.MISSING:
            return (declared.default,) * least
        return tuple(declared.default_factory() for _ in range(least))

    return dataclasses.field(default_factory=make_default, metadata={"kind": kind, "name": name})


def anything():
    """Declare what may be a message of any type."""
    return _declare(_ANYTHING, None, None)


class Message:
    """A message: a frozen dataclass with declared fields."""

    __slots__ = ()

    def __post_init__(self):
        """Check all fields."""
        for each in dataclasses.fields(self):
            value = each.metadata["kind"].check(getattr(self, each.name), _name_of(each))
            object.__setattr__(self, each.name, value)


def _name_of(field):
    return field.metadata["name"] or field.name


def read_value(written, kind):
    """Return the value that JSON says; what a message lacks has its default."""
    if kind is _ANYTHING:
        _refuse(None, None)
    depth = 0
    for match in re.finditer(r'"(?:[^"\\]|\\.)*"|[\[\]{}]', written):
        depth += {"[": 1, "{": 1, "]": -1, "}": -1}.get(match[0], 0)
        if depth > _DEEPEST:
            raise SimulationError("the value is nested too deeply")
    try:
        read = json.loads(
            written,
            parse_int=_Token,
            parse_float=_Token,
            parse_constant=_Token,
            object_pairs_hook=_join_pairs,
        )
    except json.JSONDecodeError as error:
        raise SimulationError(f"character {error.pos + 1} of the value: {error.msg}") from None
    return kind.read(read, "the value")


def _join_pairs(pairs):
    names = [name for name, _ in pairs]
    if len(set(names)) < len(names):
        raise SimulationError("a name stands twice in the value")
    return dict(pairs)


def write_value(value):
    """Return a value as JSON of printable ASCII on one line.

    A number has the fewest digits that give it back.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _write_number(value)
    if isinstance(value, str):
        return json.dumps(value).replace("\x7f", "\\u007f")
    if isinstance(value, (list, tuple)):
        return f"[{','.join(write_value(each) for each in value)}]"
    names = {each.name: _name_of(each) for each in dataclasses.fields(value)}
    fields = (f"{write_value(names[key])}:{write_value(getattr(value, key))}" for key in names)
    return "{" + ",".join(fields) + "}"


def _write_number(value):
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "Infinity" if value > 0 else "-Infinity"
    if value == 0:
        return "-0.0" if math.copysign(1, value) < 0 else "0.0"
    count = 1
    written = f"{abs(value):.0e}"
    while count < _MOST_DIGITS and float(written) != abs(value):
        count += 1
        written = f"{abs(value):.{count - 1}e}"
    mantissa, _, exponent_text = written.partition("e")
    digits = mantissa.replace(".", "").rstrip("0")
    return ("-" if value < 0 else "") + _place(digits, int(exponent_text))


def _place(digits, exponent):
    if exponent not in _PLAIN_EXPONENTS:
        fraction = f".{digits[1:]}" if len(digits) > 1 else ""
        return f"{digits[0]}{fraction}e{'-' if exponent < 0 else '+'}{abs(exponent):02d}"
    if exponent < 0:
        return "0." + "0" * (-exponent - 1) + digits
    padded = digits.ljust(exponent + 1, "0")
    return f"{padded[: exponent + 1]}.{padded[exponent + 1 :] or '0'}"
