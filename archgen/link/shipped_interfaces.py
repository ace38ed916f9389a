"""The interfaces that ship with archgen, by distribution: names are read for each, fields only when one is asked for."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from archgen.model.known_interfaces import KNOWN_DISTROS, Interface, InterfaceField, Interfaces

_DATA_FOLDER = Path(__file__).resolve().parent / "ros_interfaces"
# tools/make_ros_interfaces.py writes no fields for rolling: they are lyrical's.
_SAME_FIELDS_AS = {"rolling": "lyrical"}


class LazyInterfaces(Mapping[str, Interface]):
    """The definitions of interfaces by full name: the project's own, and those that ship, which are read on first use.

    A file of fields is read only when one of its messages is asked for, and then only that message is parsed.
    """

    __slots__ = ("_distros", "_own_interfaces")

    def __init__(self, distros: tuple[str, ...], own_interfaces: Mapping[str, Interface]) -> None:
        """Remember the project's own interfaces, and the distributions to search after them, in order."""
        self._distros = distros
        self._own_interfaces = own_interfaces

    def __getitem__(self, name: str) -> Interface:
        """Return the definition of `package/msg/Name`; raise KeyError where there is none."""
        definition: Interface | None = self.get(name)
        if definition is None:
            raise KeyError(name)
        return definition

    # A method of its own: most names that are asked for are `float64` and the like, and an exception for each takes long.
    def get(self, name: str, default: Any = None) -> Any:  # noqa: ANN401 - as Mapping has it
        """Return the definition of `package/msg/Name`, or another value where there is none."""
        if name in self._own_interfaces:
            return self._own_interfaces[name]
        for distro in self._distros:
            if name in _load_fields(distro):
                return _parse_interface(distro, name)
        return default

    def __iter__(self) -> Iterator[str]:
        """Iterate over all names, the project's own first, each once."""
        return iter(
            dict.fromkeys([*self._own_interfaces, *(name for distro in self._distros for name in _load_fields(distro))])
        )

    def __len__(self) -> int:
        """Count the definitions."""
        return sum(1 for _ in self)


class LazyHoldingDistros(Mapping[str, tuple[str, ...]]):
    """The distributions that have an interface, by full name; read when the first name is asked for."""

    __slots__ = ()

    def __getitem__(self, name: str) -> tuple[str, ...]:
        """Return the distributions that have `package/msg/Name`; raise KeyError where there is none."""
        return _load_holding_distros()[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names that any distribution has."""
        return iter(_load_holding_distros())

    def __len__(self) -> int:
        """Count these names."""
        return len(_load_holding_distros())


def list_answering_distros(distro: str | None) -> tuple[str, ...]:
    """Return the distributions whose data answer for a project's distribution: all for None, none if unknown."""
    return KNOWN_DISTROS if distro is None else (distro,) if distro in KNOWN_DISTROS else ()


@cache
def load_shipped_interfaces(distro: str | None) -> Interfaces:
    """Return the interfaces that ship for a distribution; for None, those of all distributions."""
    names, whole_packages, patch_packages = set[str](), set[str](), set[str]()
    for data_distro in list_answering_distros(distro):
        names.update(_list_names(data_distro))
        # Without a distribution nothing is "whole": a name that one lacks may exist in another.
        if distro is not None:
            packages = _load_names(data_distro)
            whole_packages.update(package for package, entry in packages.items() if entry["whole"])
            patch_packages.update(package for package, entry in packages.items() if entry.get("patch"))
    return Interfaces(
        distro,
        frozenset(names),
        frozenset(whole_packages),
        LazyInterfaces(list_answering_distros(distro), {}),
        has_names=bool(list_answering_distros(distro)),
        patch_packages=frozenset(patch_packages),
        holding_distros=LazyHoldingDistros(),
    )


@cache
def _load_holding_distros() -> dict[str, tuple[str, ...]]:
    distros_by_name = dict[str, tuple[str, ...]]()
    for distro in sorted(KNOWN_DISTROS):
        for name in _list_names(distro):
            distros_by_name[name] = (*distros_by_name.get(name, ()), distro)
    return distros_by_name


def _list_names(distro: str) -> Iterator[str]:
    return (
        f"{package}/{kind}/{name}"
        for package, kinds in _load_names(distro).items()
        for kind in ("msg", "srv", "action")
        for name in kinds.get(kind, ())
    )


@cache
def _load_names(distro: str) -> dict[str, dict[str, Any]]:
    names_by_package: dict[str, dict[str, Any]] = json.loads(
        (_DATA_FOLDER / f"{distro}.names.json").read_text(encoding="utf-8")
    )
    return names_by_package


# Cached, and shared with callers that only look names up: LazyInterfaces asks for every single message.
@cache
def _load_fields(distro: str) -> dict[str, list[str]]:
    file = _DATA_FOLDER / f"{_SAME_FIELDS_AS.get(distro, distro)}.fields.json"
    fields_by_interface: dict[str, list[str]] = json.loads(file.read_text(encoding="utf-8"))
    return fields_by_interface


@lru_cache(4096)
def _parse_interface(distro: str, name: str) -> Interface:
    """Parse an interface of a distribution. Views ask for the same ones again and again."""
    return Interface(name, (tuple(_parse_field(text) for text in _load_fields(distro)[name]),))


def _parse_field(text: str) -> InterfaceField:
    """Parse a field as the data files hold it: `float64[36] covariance`."""
    type_text, name = text.split(" ")
    base, bracket, size = type_text.partition("[")
    return InterfaceField(name, base, bracket + size)
