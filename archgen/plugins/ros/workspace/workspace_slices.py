"""The architecture that a workspace becomes, as slices: groups of components that are wired as topics are, nodes, variants.

Who answers for the packages of a workspace: what CODEOWNERS files of its repositories say of their folders.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import FlowMapping, ForeignFileError, link_slices, make_id, make_unique_id, read_bounded
from archgen.plugin.model import Architecture
from archgen.plugins.ros.launch.launch_entities import LaunchedNode
from archgen.plugins.ros.launch.launch_import import SliceMaker
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.workspace.node_components import LIBRARY, NodeKnowledge, NodeWriter, WrittenNode
from archgen.plugins.ros.workspace.program_sources import WorkspaceFiles

_CODEOWNERS_PLACES = ("CODEOWNERS", ".github/CODEOWNERS", "docs/CODEOWNERS", ".gitlab/CODEOWNERS")
_MAX_CODEOWNERS_BYTES = 1_000_000
_GLOB_SIGNS = frozenset("*?[")


class CodeOwners:
    """The CODEOWNERS files of the repositories below some folders, each read once."""

    def __init__(self, roots: Iterable[Path], account: ImportAccount) -> None:
        self._roots = frozenset(root.resolve() for root in roots)
        self._account = account
        self._ids: dict[str, str] = {}
        self._rules: dict[Path, list[tuple[str, tuple[str, ...]]] | None] = {}

    def find_owners(self, folder: Path) -> tuple[str, ...]:
        """Return the owners of a folder as they are written (`@org/team`): those of the last line that names it."""
        for top in (folder, *folder.parents):
            rules = self._read_rules(top)
            if rules is not None:
                path = folder.relative_to(top).as_posix()
                return next((owners for pattern, owners in reversed(rules) if _names_folder(pattern, path)), ())
            if top in self._roots:
                break
        return ()

    def name_partners(self, folder: Path) -> str | list[str] | None:
        """Return the partners that own a folder, as a component says them; None where nobody does."""
        names = []
        for owner in dict.fromkeys(self.find_owners(folder)):
            if owner not in self._ids:
                word = owner.lstrip("@").rpartition("/")[2].partition("@")[0]
                self._ids[owner] = make_unique_id(make_id(word, "partner"), set(self._ids.values()))
            names.append(self._ids[owner])
        return names[0] if len(names) == 1 else names or None

    def write_partners(self) -> dict[str, dict[str, object]]:
        """Return the partners that were named, with who reviews for them."""
        return {name: {"title": owner, "reviewers": [owner]} for owner, name in self._ids.items()}

    def _read_rules(self, top: Path) -> list[tuple[str, tuple[str, ...]]] | None:
        if top not in self._rules:
            files = (top / place for place in _CODEOWNERS_PLACES)
            file = next((file for file in files if file.is_file() and not file.is_symlink()), None)
            self._rules[top] = None if file is None else list(self._parse_file(file))
        return self._rules[top]

    def _parse_file(self, file: Path) -> Iterator[tuple[str, tuple[str, ...]]]:
        try:
            text = read_bounded(file, _MAX_CODEOWNERS_BYTES).decode("utf-8", "replace")
        except ForeignFileError as error:
            self._account.add_note("CODEOWNERS", error.message, error.span, error.help_line)
            return
        for line in text.splitlines():
            words = line.partition("#")[0].split()
            # GitLab's heads of sections stand in brackets.
            if words and not words[0].startswith(("[", "^[")):
                yield words[0], tuple(words[1:])


def _names_folder(pattern: str, folder: str) -> bool:
    """Whether a pattern is about all that lies in a folder. Patterns of files, such as `*.py`, are about none."""
    name = pattern.removesuffix("**").removesuffix("*").rstrip("/")
    if not name:
        return True
    if _GLOB_SIGNS & set(name):
        return False
    if "/" in name:
        return f"{folder}/".startswith(f"{name.lstrip('/')}/")
    return name in folder.split("/")


Comments = dict[tuple[str | int, ...], str]
_VERBS = {"topic": "publishes", "service": "serves", "action": "serves"}
_ONE_GROUP = "robot"
_OTHER_GROUP = "others"


@dataclass(frozen=True, slots=True)
class MadeSlices:
    """The slices, one for each group, the comments behind their lines, and the nodes in them as they come out linked."""

    slices: Mapping[str, Mapping[str, Any]]
    comments: Mapping[str, Comments]
    nodes: Sequence[WrittenNode]
    architecture: Architecture


def make_slices(  # noqa: PLR0913 - what is known, and how it is to stand there
    maker: SliceMaker,
    knowledge: Sequence[NodeKnowledge],
    workspace: WorkspaceFiles,
    account: ImportAccount,
    distro: str,
    *,
    group_by: str | None = None,
) -> MadeSlices:
    """Make the slices of what is known of the nodes."""
    sections = maker.make_sections([each.node for each in knowledge])
    by_id = {node_id: each for each in knowledge if (node_id := maker.find_node_id(each.node))}
    owners = CodeOwners(workspace.roots, account)
    groups = _choose_groups({node_id: each.node for node_id, each in by_id.items()}, workspace, owners, group_by)
    writer = NodeWriter(account, distro)
    written = [
        each
        for node_id, data in sections.pop("nodes", {}).items()
        for each in writer.write_node(node_id, data, by_id[node_id], groups[node_id])
    ]
    used: set[str] = set()
    for each in written:
        package = workspace.packages.get(each.package)
        if package is not None and (owner := owners.name_partners(package.manifest.folder)):
            each.component["owner"] = owner
        _rename(each, make_unique_id(each.id, used))
        used.add(each.id)
    if partners := owners.write_partners():
        sections = {"partners": partners, **sections}
        account.count("owner", len(partners))
    project: dict[str, Any] = {"project": {"id": "workspace"}, "ros": {"distro": distro}}
    if any(each.library_type for each in knowledge):
        project["libraries"] = {LIBRARY: "builtin"}
    architecture = link_slices({**project, **sections, **_write_sections(written)})
    wiring = _Wiring(architecture, written)
    usual = [each for each in written if not each.variants]
    inputs = wiring.wire(usual)
    account.count("connection", wiring.count)
    slices: dict[str, Mapping[str, Any]] = {}
    comments: dict[str, Comments] = {}
    for group in dict.fromkeys(each.group for each in usual):
        members = [each for each in usual if each.group == group]
        own = _write_sections(members, inputs)
        own["groups"][group] = _share_owner(own["groups"][group])
        slices[f"{group}.yaml"] = {"groups": own["groups"], **sections, "nodes": own["nodes"]}
        comments[f"{group}.yaml"] = _place_comments(members, maker.comments)
        sections = {}
    variants, variant_comments = _make_variants(written, inputs, wiring)
    if variants:
        file = next(iter(slices), f"{_ONE_GROUP}.yaml")
        rest = dict(slices.get(file, sections))
        # What a variant changes is declared, also where nothing of it always runs.
        others: dict[str, Any] = {each.group: {} for each in written if f"{each.group}.yaml" not in slices}
        slices[file] = {"groups": {**rest.pop("groups", {}), **others}, **rest, "variants": variants}
        comments[file] = {**comments.get(file, {}), **variant_comments}
        account.count("variant", len(variants))
    return MadeSlices(slices, comments, written, architecture)


def _rename(node: WrittenNode, new_id: str) -> None:
    if new_id != node.id:
        node.data.setdefault("name", node.id)
        node.id, node.data["implements"] = new_id, f"{node.group}.{new_id}"


def _choose_groups(
    launched: Mapping[str, LaunchedNode], workspace: WorkspaceFiles, owners: CodeOwners, group_by: str | None
) -> dict[str, str]:
    """Return the group of each node: as it was asked for, else by the folder of its package, by its namespace, or one for all."""
    places: dict[str, dict[str, str]] = {each: {} for each in ("folder", "namespace", "package", "codeowners")}
    for node_id, node in launched.items():
        package = workspace.packages.get(node.package)
        parts = package.manifest_name.split("/") if package is not None else []
        named = owners.name_partners(package.manifest.folder) if package is not None else None
        places["folder"][node_id] = parts[0] if len(parts) > 2 else ""  # noqa: PLR2004 - folder, package, package.xml
        places["namespace"][node_id] = node.namespace.strip("/").partition("/")[0]
        places["package"][node_id] = node.package
        places["codeowners"][node_id] = (named if isinstance(named, str) else named[0]) if named else ""
    fewest = 1 if group_by else 2
    for way in (group_by,) if group_by else ("folder", "namespace"):
        if len(set(filter(None, places[way].values()))) >= fewest:
            return {node_id: make_id(place or _OTHER_GROUP, "group") for node_id, place in places[way].items()}
    return dict.fromkeys(launched, _ONE_GROUP)


def _write_sections(nodes: Iterable[WrittenNode], inputs: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return groups and nodes, with the wiring of their components where it is known."""
    groups: dict[str, Any] = {}
    sections: dict[str, Any] = {"groups": groups, "nodes": {}}
    for node in nodes:
        component = dict(node.component)
        if inputs is not None:
            component.pop("inputs", None)
            outputs = component.pop("outputs", None)
            component |= {"inputs": inputs[node.id]} if inputs[node.id] else {}
            component |= {"outputs": outputs} if outputs else {}
        groups.setdefault(node.group, {"components": {}})["components"][node.id] = component or None
        sections["nodes"][node.id] = node.data
    return sections


def _share_owner(group: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a group that says the owner of its components where all have the same one."""
    components = group["components"]
    owner, *others = ((body or {}).get("owner") for body in components.values())
    if not owner or any(other != owner for other in others):
        return group
    bodies = {name: {key: value for key, value in body.items() if key != "owner"} for name, body in components.items()}
    return {"owner": owner, "components": {name: body or None for name, body in bodies.items()}}


def _place_comments(nodes: Iterable[WrittenNode], launch_comments: Comments, above: tuple[str, ...] = ()) -> Comments:
    comments = {
        (*above, *path): text for path, text in launch_comments.items() if path[0] == "containers" and not above
    }
    for node in nodes:
        path = ("nodes", node.id)
        texts = [text for text in (launch_comments.get(path), node.comments.get(())) if text]
        comments |= {(*above, *path): "; ".join(texts)} if texts else {}
        for inner, text in node.comments.items():
            comments |= {(*above, "groups", node.group, "components", node.id, *inner): text} if inner else {}
    return comments


def _make_variants(
    written: Sequence[WrittenNode], usual_inputs: Mapping[str, Any], wiring: _Wiring
) -> tuple[dict[str, Any], Comments]:
    """Return the variants in which nodes run that are off by default, or that one of several launch files starts."""
    usual = [each for each in written if not each.variants]
    variants: dict[str, Any] = {}
    comments: Comments = {}
    by_variant: dict[tuple[str, str], list[WrittenNode]] = defaultdict(list)
    for each in written:
        for variant in each.variants.items():
            by_variant[variant].append(each)
    for (wanted, title), added in by_variant.items():
        name = make_unique_id(wanted, variants.keys())
        stopped = [each for each in usual if _runs_instead(each, added)]
        running = [each for each in usual if each not in stopped]
        inputs = wiring.wire([*running, *added])
        changes = _write_sections(added, inputs)
        for node in running:
            changed = {key: value for key, value in inputs[node.id].items() if usual_inputs[node.id].get(key) != value}
            if changed:
                group = changes["groups"].setdefault(node.group, {"components": {}})
                group["components"][node.id] = {"inputs": changed}
        without = {"without": " ".join(f"{each.group}.{each.id}" for each in stopped)} if stopped else {}
        variants[name] = {"title": title, **without, "changes": changes}
        comments |= _place_comments(added, {}, ("variants", name, "changes"))
    return variants, comments


def _runs_instead(node: WrittenNode, others: Iterable[WrittenNode]) -> bool:
    """Whether a node runs only where others do not: unless what they run if."""
    contrary = {
        condition.replace("if ", "unless ", 1)
        if condition.startswith("if ")
        else condition.replace("unless ", "if ", 1)
        for other in others
        if other.known is not None and not other.known.node.is_on
        for condition in other.known.node.conditions
    }
    return node.known is not None and not contrary.isdisjoint(node.known.node.conditions)


class _Wiring:
    """Who reads what of whom, by the names that count on the robot."""

    def __init__(self, architecture: Architecture, written: Sequence[WrittenNode]) -> None:
        self._architecture = architecture
        self._written = {f"{each.group}.{each.id}": each for each in written}
        self.count = 0
        """How many connections were made last."""

    def wire(self, nodes: Sequence[WrittenNode]) -> dict[str, dict[str, Any]]:
        """Return the inputs of the nodes' components, if these are all that run. What none of them writes comes from outside."""
        running = {f"{each.group}.{each.id}" for each in nodes}
        endpoints = [
            each for each in self._architecture.endpoints if each.component in running and each.port is not None
        ]
        writers: dict[tuple[str, str | None], list[str]] = defaultdict(list)
        for each in endpoints:
            if each.use in {"publishes", "serves"} and each.port not in writers[each.flow, each.name]:
                writers[each.flow, each.name].append(str(each.port))
        self.count = 0
        inputs: dict[str, dict[str, Any]] = {each.id: FlowMapping() for each in nodes}
        for each in endpoints:
            if each.use not in {"subscribes", "calls"} or each.internal:
                continue
            component, _, port = str(each.port).rpartition(".")
            node = self._written[component]
            own = node.component.get("inputs", {}).get(port)
            typed = {"type": own["type"]} if own and own["type"] else {}
            found = (
                []
                if each.name is None
                else [w for w in writers[each.flow, each.name] if not w.startswith(f"{component}.")]
            )
            sources = [source.removeprefix(f"{node.group}.") for source in found]
            if sources:
                before = inputs[node.id].get(port)
                sources = list(
                    dict.fromkeys(
                        [
                            *(before if isinstance(before, list) else [before] if isinstance(before, str) else []),
                            *sources,
                        ]
                    )
                )
                self.count += len(sources)
                # What a type of the library says otherwise is said, too.
                is_same = "is" not in node.component and all(
                    self._architecture.outputs[source].type == typed.get("type") for source in found
                )
                given: Any = sources[0] if len(sources) == 1 else sources
                inputs[node.id][port] = given if is_same or not typed else FlowMapping({"from": given, **typed})
            elif own is not None or not self._architecture.inputs[str(each.port)].optional:
                where = f"Nobody here {_VERBS[each.flow]} {each.name}" if each.name else "Its name is not known"
                starter = each.name and each.use == "subscribes" and self._find_other_way(each.name)
                where = f"{starter} in another way to start it than this one" if starter else where
                inputs[node.id].setdefault(port, FlowMapping({"external": where, **typed}))
        return inputs

    def _find_other_way(self, name: str) -> str:
        """Return which node a remap gives a name in a way to start it that is kept as a hint; empty where none does."""
        for node in self._written.values():
            ways = node.known.node.other_ways if node.known is not None else ()
            base = f"/{node.known.node.namespace.strip('/')}".rstrip("/") if node.known is not None else ""
            if any(name in {to, f"{base}/{to}"} for way in ways for to in way.get("remaps", {}).values()):
                return f"{node.id} has {name}"
        return ""
