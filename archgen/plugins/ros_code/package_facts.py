"""What a package.xml says of every package that is generated: version, maintainer, license, and what it needs."""

from __future__ import annotations

import re
from collections.abc import Iterable

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import GenerationContext, tell_left_out
from archgen.plugin.model import Architecture, Partner

_VERSION = re.compile(r"[0-9]+\.[0-9]+\.[0-9]+\Z", re.ASCII)
_ADDRESS = re.compile(r"(?<![A-Za-z0-9._%+-])[A-Za-z0-9._%+-]++@[A-Za-z0-9-]+(?:\.[A-Za-z0-9-]+)+", re.ASCII)

_ROSDEP = "rosdep"
_ROSDEP_KEY = re.compile(r"[A-Za-z0-9][A-Za-z0-9+._-]*\Z", re.ASCII)


class RosdepKeys:
    """By which keys rosdep knows packages and programs: their own names, unless `hints: {rosdep: KEY}` say another one.

    A node or container says it of its package, one without a package of its program; a type of the package of its message.
    """

    def __init__(self, architecture: Architecture) -> None:
        """Read the hints of nodes, containers and types; `findings` tell those that are no key."""
        self.findings: list[Diagnostic] = []
        self._by_package: dict[str, str] = {}
        self._by_program: dict[str, str] = {}
        hinted = [(each.id, each.package or "", each.annotations, each.at) for each in architecture.nodes.values()]
        hinted += [
            (each.id, each.package or "", each.annotations, each.at) for each in architecture.containers.values()
        ]
        for data_type in architecture.types.values():
            package = (data_type.message or "").partition("/")[0]
            hinted.append((data_type.name, package, data_type.annotations, data_type.at))
        for element, package, told, at in hinted:
            key = told.hints.get(_ROSDEP)
            if key is None:
                continue
            known = self._by_package.get(package, key)
            if not isinstance(key, str) or not _ROSDEP_KEY.match(key):
                message = f"the hint `rosdep` of `{element}` is no key of rosdep"
                help_line = "a key is one word: `hints: {rosdep: libusb-1.0-dev}`"
            elif known != key:
                message = (
                    f"`{element}` says that rosdep knows the package `{package}` as `{key}`, another one as `{known}`"
                )
                help_line = "write it at one of them"
            else:
                (self._by_package if package else self._by_program)[package or element] = key
                continue
            place = told.hint_places.get((_ROSDEP,), at)
            self.findings.append(tell_left_out(message, place, element=element, help_line=help_line))

    def list_keys(self, packages: Iterable[str], programs: Iterable[str] = ()) -> list[str]:
        """Return the keys of packages, and of the programs of nodes that have one."""
        keys = {self._by_package.get(each, each) for each in packages}
        return sorted(keys | {self._by_program[each] for each in programs if each in self._by_program})


def record_package_facts(context: GenerationContext, owner: str | None = None) -> dict[str, str]:
    """Return version, title, maintainer, address and license. The options `maintainer`, `email`, `license` win.

    `owner` is the partner whose package it is; without one the project's only partner.
    """
    architecture, options = context.architecture, context.options
    partner = architecture.partners.get(owner or "") or _find_only_partner(context)
    version = architecture.project.version or ""
    address = _ADDRESS.search(partner.contact or "") if partner else None
    return {
        "version": version if _VERSION.match(version) else "0.0.0",
        "title": architecture.project.title,
        "maintainer": options.get("maintainer") or (partner.title if partner else architecture.project.title),
        # What ros2 pkg create and catkin_create_pkg write where nobody says it.
        "maintainer_email": options.get("email") or (address[0] if address else "todo@todo.todo"),
        "license": options.get("license") or architecture.project.license or "TODO: License declaration",
    }


def _find_only_partner(context: GenerationContext) -> Partner | None:
    partners = tuple(context.architecture.partners.values())
    return partners[0] if len(partners) == 1 else None
