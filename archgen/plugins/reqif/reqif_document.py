"""What a ReqIF file holds, as far as it is read: objects with values, types, hierarchies, relations."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(slots=True)
class ReqifObject:
    """An object; `values` are texts by the id of the attribute, of enumerations the ids of the values."""

    id: str
    long_name: str
    file: str
    line: int
    type_id: str = ""
    values: dict[str, str] = field(default_factory=dict)
    choices: dict[str, list[str]] = field(default_factory=dict)


@dataclass(slots=True)
class ReqifRelation:
    """A relation from one object to another."""

    type_id: str = ""
    source: str = ""
    target: str = ""


@dataclass(slots=True)
class HierarchyEntry:
    """An object where it stands in a specification; `parent` is the position of the entry above, -1 at the top."""

    object_id: str
    specification: str
    parent: int


@dataclass(slots=True)
class ReqifDocument:
    """All that was read of the files, by their ids."""

    source_tool: str = ""
    objects: dict[str, ReqifObject] = field(default_factory=dict)
    repeated: list[ReqifObject] = field(default_factory=list)
    """Objects whose id another one has already."""
    names: dict[str, str] = field(default_factory=dict)
    """The long names of types, attributes and values of enumerations."""
    relations: list[ReqifRelation] = field(default_factory=list)
    entries: list[HierarchyEntry] = field(default_factory=list)
