"""Values of launch arguments that are given on the command line, and what files declare: a name that none declares is refused."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.plugin.importing import ForeignFileError, Span, find_closest

_MAX_SHOWN = 12


@dataclass(slots=True)
class DeclaredArgument:
    """An argument as a file declares it. `is_fixed` is one of ROS 1 with a `value`, which nobody can set from outside."""

    span: Span
    choices: tuple[str, ...] = ()
    is_fixed: bool = False


@dataclass(slots=True)
class LaunchArguments:
    """What is given for launch arguments, and what the files that were read say of them."""

    given: Mapping[str, str] = field(default_factory=dict)
    _declared: dict[str, DeclaredArgument] = field(default_factory=dict)

    def declare(self, name: str, argument: DeclaredArgument) -> None:
        """Remember an argument. Of several declarations one that can be set counts, then the first."""
        known = self._declared.get(name)
        if known is None or (known.is_fixed and not argument.is_fixed):
            self._declared[name] = argument

    def refuse_unknown(self, asked_names: Iterable[str], file: str) -> None:
        """Raise ForeignFileError for what is given and no file declares or asks for, or what it cannot be."""
        asked_names = frozenset(asked_names)
        for name, value in self.given.items():
            argument = self._declared.get(name)
            if argument is None and name in asked_names:
                continue
            if argument is None:
                words = f"no launch file that is read declares an argument `{name}`"
                raise ForeignFileError(words, Span.of_file(file), self._suggest(name))
            if argument.is_fixed:
                words = f"the argument `{name}` has a fixed value here, and cannot be set"
                raise ForeignFileError(words, argument.span, f"leave out `{name}:={value}`, or declare a `default`")
            if argument.choices and value not in argument.choices:
                words = f"`{value}` is none of the choices of the argument `{name}`"
                raise ForeignFileError(words, argument.span, f"it is one of {', '.join(argument.choices)}")

    def _suggest(self, name: str) -> str:
        names = sorted(each for each, argument in self._declared.items() if not argument.is_fixed)
        closest = find_closest(name, names)
        if closest is not None:
            return f"did you mean `{closest}`?"
        if not names:
            return "they declare none"
        more = f" and {len(names) - _MAX_SHOWN} more" if len(names) > _MAX_SHOWN else ""
        return f"they declare {', '.join(names[:_MAX_SHOWN])}{more}"
