"""The part of archgen that plug-ins may use, by subject; docs/plugins.md says how. A name that leaves is announced one release before.

A module of it is imported by plug-ins alone: what is here says which of the core's names others may rely on.
"""

from archgen.frozen import dataclass, replace
from archgen.installed_plugins import API

__all__ = ["API", "dataclass", "replace"]
