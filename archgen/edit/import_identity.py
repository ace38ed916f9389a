"""Who is who between two imports: elements keep the ids, places and files that they have, whatever their source calls them by now.

Nodes of ROS are known by their full names, else by their ids, else by the one program that went and came, else by what they publish,
read, serve and call. Components are known by the node that is theirs; elements of other tools by the ids that `hints` hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from archgen.compare.element_likeness import Feature, find_likely_pairs
from archgen.edit.earlier_import import copy_mapping, put_value
from archgen.frozen import dataclass, field
from archgen.grouping import group_pairs
from archgen.model.element_ids import make_id, make_unique_id

Slices = Mapping[str, Mapping[str, Any]]
"""Sections of the language by the names of their files."""
Comments = Mapping[tuple[str | int, ...], str]

_PLACE_KEYS = frozenset({"from", "implements", "connects"})
"""Keys whose values name components by their groups."""
_NODE_SECTIONS = ("nodes", "containers")
USES = ("publishes", "subscribes", "serves", "calls")
_PROGRAM_KEYS = ("package", "executable", "plugin")
_SAME_SHARE = 0.8
"""Nodes with so large a share of their endpoints in common are one node under two names."""
_LEAST_COMMON = 2
_LIKENESS_WEIGHT = 10.0


@dataclass(slots=True)
class KeptIdentities:
    """Slices whose elements are called and placed as they are known, and what this undoes."""

    slices: Mapping[str, Mapping[str, Any]]
    comments: dict[tuple[str | int, ...], str]
    renames: dict[str, str] = field(default_factory=dict)
    """By the kept id of each node or container (`nodes.lidar`) that has another full name by now: that one."""
    moves: dict[str, str] = field(default_factory=dict)
    """Where components of another tool stand, by the places that it has them in by now."""
    node_ids: dict[str, str] = field(default_factory=dict)
    """The ids of nodes, by those that the source has for them by now."""


def keep_identities(
    slices: Slices, known: Slices, others: Mapping[str, Any], tool: str, comments: Comments | None = None
) -> KeptIdentities:
    """Return slices with the ids of `known`, what is known of the same source. `others` is what other files of the project say."""
    ids = {section: _Elements(section, slices, known, others).keep_ids() for section in _NODE_SECTIONS}
    moves = _list_moves(slices, known, tool, ids["nodes"].ids)
    renaming = _Renaming(slices, {section: each.ids for section, each in ids.items()}, moves)
    renamed = {name: renaming.rename(data) for name, data in slices.items()}
    if known:
        renamed = _keep_tool_ids(renamed, list_known_ids(known, tool), tool)
    told = {f"{section}.{kept}": name for section, each in ids.items() for kept, name in each.new_names.items()}
    # Those of nodes stand where people put them.
    told_moves = {place: moves[place] for place in list_tool_places(slices, tool).values() if place in moves}
    return KeptIdentities(
        renamed,
        {renaming.rename_path(path): text for path, text in (comments or {}).items()},
        told,
        told_moves,
        ids["nodes"].ids,
    )


def keep_files(slices: Slices, known: Slices) -> dict[str, dict[str, Any]]:
    """Return slices whose elements stand in the files where they are known."""
    files = {path: name for name, data in known.items() for path in _list_elements(data)}
    kept: dict[str, dict[str, Any]] = {name: {} for name in slices}
    for name, data in slices.items():
        paths = set(_list_elements(data))
        for path, value in _split_elements(data, paths):
            put_value(kept.setdefault(files.get(path, name), {}), path, value)
    return kept


def _list_elements(data: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """Yield the paths of the elements that stand together: nodes and others by their ids, components in their groups."""
    for section, elements in data.items():
        for element_id, body in elements.items() if isinstance(elements, Mapping) else ():
            components = body.get("components") if section == "groups" and isinstance(body, Mapping) else None
            if isinstance(components, Mapping):
                yield from ((section, element_id, "components", name) for name in components)
            elif section != "groups":
                yield section, element_id


def _split_elements(
    data: Mapping[str, Any], elements: set[tuple[str, ...]], path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield each element with its path, and what else stands around them."""
    for key, value in data.items():
        inner_path = (*path, key)
        if inner_path not in elements and isinstance(value, Mapping) and value and len(inner_path) < 4:  # noqa: PLR2004
            yield from _split_elements(value, elements, inner_path)
        else:
            yield inner_path, value


class _KeptIds:
    """By the ids that elements come with, those that they keep; by the kept ids the full names that are new."""

    def __init__(self) -> None:
        self.ids: dict[str, str] = {}
        self.new_names: dict[str, str] = {}


class _Elements:
    """The nodes, or containers, of an import, and those that are known."""

    def __init__(self, section: str, slices: Slices, known: Slices, others: Mapping[str, Any]) -> None:
        self._new = read_section(slices, section)
        self._old = read_section(known, section)
        self._others = {key: body for key, body in read_section({"": others}, section).items() if key not in self._old}

    def keep_ids(self) -> _KeptIds:
        kept = _KeptIds()
        pairs = kept.ids
        known = {**self._others, **self._old}
        old_by_name = _index_names(known)
        for name, new_id in _index_names(self._new).items():
            if name in old_by_name:
                pairs[new_id] = old_by_name[name]
        taken = set(pairs.values())
        pairs |= {each: each for each in self._new if each not in {*pairs, *taken} and self._is_known(each)}
        for new_id, old_id in self._pair_by_content(pairs):
            pairs[new_id] = old_id
            name = _full_name(new_id, self._new[new_id])
            # Two nodes of one name, which is a fault of the robot, are known by their programs, too.
            if name != _full_name(old_id, self._old[old_id]):
                kept.new_names[old_id] = name
        taken = {*known, *pairs.values()}
        for new_id in self._new:
            if new_id not in pairs:
                wanted = new_id
                if new_id in taken:
                    wanted = make_id(_full_name(new_id, self._new[new_id]), "node")
                pairs[new_id] = make_unique_id(wanted, taken)
                taken.add(pairs[new_id])
        return kept

    def _is_known(self, element_id: str) -> bool:
        """Whether an id is known, and other files say no other name of it."""
        other = self._others.get(element_id)
        return element_id in self._old or (other is not None and not {"name", "namespace"} & other.keys())

    def _pair_by_content(self, pairs: Mapping[str, str]) -> Iterator[tuple[str, str]]:
        """Yield new and old id of those that went under one name and came under another."""
        taken = set(pairs.values())
        lost = {key: body for key, body in self._old.items() if key not in taken}
        added = {key: body for key, body in self._new.items() if key not in pairs}
        old_programs, new_programs = _index_programs(lost), _index_programs(added)
        for program, new_id in new_programs.items():
            if program in old_programs:
                yield new_id, old_programs[program]
                del lost[old_programs[program]], added[new_id]
        old_marks, new_marks = ({key: _list_endpoints(body) for key, body in each.items()} for each in (lost, added))
        features = [
            {key: {"endpoints": Feature(_LIKENESS_WEIGHT, marks)} for key, marks in each.items() if marks}
            for each in (old_marks, new_marks)
        ]
        for old_id, new_id, _ in find_likely_pairs(*features):
            common, all_marks = old_marks[old_id] & new_marks[new_id], old_marks[old_id] | new_marks[new_id]
            if len(common) >= _LEAST_COMMON and len(common) >= _SAME_SHARE * len(all_marks):
                yield new_id, old_id


def read_section(slices: Slices, section: str) -> dict[str, Mapping[str, Any]]:
    """Return the elements of a section over all slices, by their ids."""
    return {
        element_id: read_mapping(body)
        for data in slices.values()
        for element_id, body in read_mapping(data.get(section)).items()
    }


def _full_name(element_id: str, body: Mapping[str, Any]) -> str:
    namespace = str(body.get("namespace") or "").strip("/")
    return "/".join(("", *([namespace] if namespace else []), str(body.get("name") or element_id)))


def _index_unique(pairs: Iterable[tuple[Any, str]]) -> dict[Any, str]:
    """Return ids by what only one of them has."""
    found = group_pairs(pairs)
    return {key: ids[0] for key, ids in found.items() if key and len(ids) == 1}


def _index_names(elements: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    return _index_unique((_full_name(key, body), key) for key, body in elements.items())


def _index_programs(elements: Mapping[str, Mapping[str, Any]]) -> dict[tuple[str, ...], str]:
    """Return ids by the program, where only one of them runs it, and by the launch file."""
    pairs = []
    for key, body in elements.items():
        program = tuple(str(body.get(each) or "") for each in _PROGRAM_KEYS)
        launch = read_mapping(read_mapping(body.get("hints")).get("launch"))
        pairs.append(((*program, str(launch.get("file") or "")) if any(program) else (), key))
    return _index_unique(pairs)


def _list_endpoints(body: Mapping[str, Any]) -> frozenset[str]:
    return frozenset(f"{use} {key}" for use in USES for key in read_mapping(body.get(use)))


def _list_moves(slices: Slices, known: Slices, tool: str, node_ids: Mapping[str, str]) -> dict[str, str]:
    """Return the places that components keep, by those where their source has them by now.

    The groups are the project's: others refer to components by them, and people may have sorted them anew.
    """
    new_places, old_places = list_tool_places(slices, tool), list_tool_places(known, tool)
    moves = {place: old_places[key] for key, place in new_places.items() if key in old_places}
    old_nodes = read_section(known, "nodes")
    for new_id, body in read_section(slices, "nodes").items():
        place, node_id = find_place(body), node_ids[new_id]
        if place and node_id in old_nodes:
            moves[place] = find_place(old_nodes[node_id]) or place
        elif place.rpartition(".")[2] == new_id:
            moves[place] = f"{place.rpartition('.')[0]}.{node_id}"
    moves = {place: old for place, old in moves.items() if place != old}
    # Where another component of the model stands by now, none can stay, unless that one goes, too.
    all_places = {f"{group}.{name}" for data in slices.values() for group, name, _ in list_components(data)}
    while blocked := [place for place, old in moves.items() if old in all_places - moves.keys()]:
        for place in blocked:
            del moves[place]
    return moves


def find_place(body: Mapping[str, Any]) -> str:
    """Return the place of the component that a node implements; empty where it is none, or several."""
    places = body.get("implements")
    places = places if isinstance(places, list) else [places]
    return places[0] if len(places) == 1 and isinstance(places[0], str) and places[0].count(".") == 1 else ""


class _Renaming:
    """Other ids of nodes and containers, and other places of components, wherever slices say them."""

    def __init__(
        self,
        slices: Slices,
        ids: Mapping[str, Mapping[str, str]],
        moves: Mapping[str, str],
        ports: Mapping[str, Mapping[str, str]] | None = None,
    ) -> None:
        self._ids = ids
        self._moves = moves
        self._ports = ports or {}
        self._places = {f"{group}.{name}" for data in slices.values() for group, name, _ in list_components(data)}

    def rename_id(self, section: str, element_id: str) -> str:
        return self._ids.get(section, {}).get(element_id, element_id)

    def rename_path(self, path: tuple[str | int, ...]) -> tuple[str | int, ...]:
        """Return the path of a comment."""
        match path:
            case ("nodes" | "containers" as section, str(element_id), *rest):
                return section, self.rename_id(section, element_id), *rest
            case ("groups", str(group), "components", str(name), *rest):
                ports = self._ports.get(f"{group}.{name}", {})
                rest = [ports.get(str(each), each) if number == 1 else each for number, each in enumerate(rest)]
                group, _, name = self._moves.get(f"{group}.{name}", f"{group}.{name}").partition(".")
                return "groups", group, "components", name, *rest
        return path

    def rename(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """Return the sections of a slice, or the changes of a variant."""
        renamed = {key: self._rename_value(value, key, "") for key, value in data.items() if key != "groups"}
        for section in _NODE_SECTIONS:
            if isinstance(data.get(section), Mapping):
                renamed[section] = {
                    self.rename_id(section, key): self._keep_name(body, key, self.rename_id(section, key))
                    for key, body in renamed[section].items()
                }
        groups = {"groups": self._move_components(data["groups"])} if data.get("groups") else {}
        return {key: {**renamed, **groups}[key] for key in data if key in {**renamed, **groups}}

    def _keep_name(self, body: object, new_id: str, kept_id: str) -> object:
        """Return a node that is called in ROS as before, under another id."""
        if new_id == kept_id or not isinstance(body, Mapping):
            return body
        name = body.get("name") or new_id
        rest = {key: value for key, value in body.items() if key != "name"}
        return rest if name == kept_id else {"name": name, **rest}

    def _move_components(self, groups: Mapping[str, Any]) -> dict[str, Any]:
        moved: dict[str, Any] = {}
        for group, body in groups.items():
            if not isinstance(read_mapping(body).get("components"), Mapping):
                moved[group] = body
                continue
            for key, value in body.items():
                if key != "components":
                    moved.setdefault(group, {})[key] = value
                    continue
                for name, component in value.items():
                    new_group, _, new_name = self._moves.get(f"{group}.{name}", f"{group}.{name}").partition(".")
                    target = moved.setdefault(new_group, {}).setdefault("components", {})
                    renamed = self._rename_value(component, "component", group, new_group)
                    target[new_name] = self._rename_ports(renamed, self._ports.get(f"{group}.{name}", {}))
        return moved

    def _rename_ports(self, component: Any, ports: Mapping[str, str]) -> Any:  # noqa: ANN401 - plain data
        if not ports:
            return component
        return copy_mapping(
            component,
            {
                side: copy_mapping(value, {ports.get(port, port): each for port, each in value.items()})
                if side in {"inputs", "outputs"}
                else value
                for side, value in component.items()
            },
        )

    def _rename_value(self, value: Any, key: str, group: str, new_group: str = "") -> Any:  # noqa: ANN401 - plain data
        """Return plain data in which what names components names them where they stand. `key` is what it stands at."""
        if isinstance(value, Mapping):
            if key == "changes":
                return self.rename(value)
            holds_sources = key == "inputs" and group
            return copy_mapping(
                value,
                {
                    inner: self._rename_value(
                        each, "from" if holds_sources and not isinstance(each, Mapping) else inner, group, new_group
                    )
                    for inner, each in value.items()
                },
            )
        if isinstance(value, list):
            return [self._rename_value(each, key, group, new_group) for each in value]
        if isinstance(value, str) and key in _PLACE_KEYS:
            return self._rename_place(value, group, new_group)
        return self.rename_id("containers", value) if isinstance(value, str) and key == "container" else value

    def _rename_place(self, text: str, group: str, new_group: str) -> str:
        """Return the name of a component or port, with its group or as seen from its group."""
        words = text.split(".")
        place, is_absolute = ".".join(words[:2]), True
        if place not in self._places and group:
            place, is_absolute = f"{group}.{words[0]}", False
        if place not in self._places:
            return text
        rest = words[2:] if is_absolute else words[1:]
        rest[:1] = [self._ports.get(place, {}).get(port, port) for port in rest[:1]]
        target_group, _, name = self._moves.get(place, place).partition(".")
        return ".".join((*([target_group] if is_absolute or target_group != new_group else []), name, *rest))


def rename_ports(
    slices: Slices, ports: Mapping[str, Mapping[str, str]], comments: Comments
) -> tuple[dict[str, dict[str, Any]], dict[tuple[str | int, ...], str]]:
    """Return slices and comments with other ids of ports, by the places of their components."""
    renaming = _Renaming(slices, {}, {}, ports)
    renamed = {name: renaming.rename(data) for name, data in slices.items()}
    return renamed, {renaming.rename_path(path): text for path, text in comments.items()}


def list_known_ids(slices: Slices, tool: str) -> dict[str, str]:
    """Return the ids of elements by those that they have in another tool (`hints: {uml: {id: ...}}`)."""
    known: dict[str, str] = {}
    for data in slices.values():
        for element_id, tool_id in _walk_hints(data, tool):
            known.setdefault(tool_id, element_id)
    return known


def _walk_hints(data: Mapping[str, Any], tool: str) -> Iterator[tuple[str, str]]:
    """Yield the id of each element with that in another tool."""
    for key, value in data.items():
        if isinstance(value, Mapping):
            if tool_id := _read_tool_id(value, tool):
                yield key, tool_id
            yield from _walk_hints(value, tool)


def _read_tool_id(body: Mapping[str, Any], tool: str) -> str:
    """Return the id that an element has in another tool; empty where nothing says it."""
    tool_id = read_mapping(read_mapping(body.get("hints")).get(tool)).get("id")
    return tool_id if isinstance(tool_id, str) else ""


def _keep_tool_ids(data: Any, known_ids: Mapping[str, str], tool: str) -> Any:  # noqa: ANN401 - plain data
    """Return plain data whose elements have the ids by which another tool's are known."""
    if not known_ids or not isinstance(data, Mapping):
        return data
    renamed = {}
    for key, value in data.items():
        tool_id = _read_tool_id(value, tool) if isinstance(value, Mapping) else ""
        kept = known_ids.get(tool_id, key)
        renamed[key if kept in data else kept] = _keep_tool_ids(value, known_ids, tool)
    return copy_mapping(data, renamed)


def list_tool_places(slices: Slices, tool: str) -> dict[str, str]:
    """Return group and id of each component that stands directly in a group, by its id in another tool."""
    places: dict[str, str] = {}
    for data in slices.values():
        for group_id, name, body in list_components(data):
            if tool_id := _read_tool_id(body, tool):
                places.setdefault(tool_id, f"{group_id}.{name}")
    return places


def list_components(data: Mapping[str, Any]) -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    """Yield group, id and body of each component that stands directly in a group."""
    for group_id, group in read_mapping(data.get("groups")).items():
        for name, body in read_mapping(read_mapping(group).get("components")).items():
            yield group_id, name, read_mapping(body)


def read_mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping, or an empty one in the place of anything else."""
    return value if isinstance(value, Mapping) else {}
