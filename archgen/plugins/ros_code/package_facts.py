"""What a package.xml says of every package that is generated: version, maintainer, license."""

from __future__ import annotations

import re

from archgen.plugin.generating import GenerationContext
from archgen.plugin.model import Partner

_VERSION = re.compile(r"[0-9]+\.[0-9]+\.[0-9]+\Z", re.ASCII)
_ADDRESS = re.compile(r"(?<![A-Za-z0-9._%+-])[A-Za-z0-9._%+-]++@[A-Za-z0-9-]+(?:\.[A-Za-z0-9-]+)+", re.ASCII)


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
        "license": options.get("license") or "TODO: License declaration",
    }


def _find_only_partner(context: GenerationContext) -> Partner | None:
    partners = tuple(context.architecture.partners.values())
    return partners[0] if len(partners) == 1 else None
