"""Lay one variant over a merged project: keys that it drops go, what it writes wins, what it selects is taken out.

What a variant writes to: it may add elements, but a slip in an id must not make a second one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from archgen.compose import expand_project
from archgen.compose.variant_overlay import MissingKey, drop_key, lay_changes
from archgen.diagnostics import Diagnostic, Severity, did_you_mean
from archgen.frozen import dataclass
from archgen.language.language_tables import DECLARING_KEYS, KEYS, SECTION_KINDS
from archgen.link import mapping_values
from archgen.link.link_memory import LinkMemory
from archgen.link.slice_merging import declares_itself, find_incomplete
from archgen.link.variants.element_removal import ElementRemover, prune_selectors, select_left_out
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import SelectorEvaluator
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode

if TYPE_CHECKING:
    from archgen.compose.type_table import MissingTypeDescriber

_NAMING_SECTIONS = ("groups", "nodes", "component_types", "libraries", "project")
"""Sections that have a say in what the inputs of components read."""
_KEPT_SECTIONS = KEYS["slice"].keys() - KEYS["variant_changes"].keys()
"""Sections that no variant changes: what the project is, its files, and who judges it."""


@dataclass(frozen=True, slots=True)
class LaidVariant:
    """A merged project with a variant laid over it, and what is wrong with the variant."""

    root: MappingNode
    diagnostics: tuple[Diagnostic, ...] = ()


class VariantLayer:
    """Lays variants over one project. `lost_keys` are the keys of what could not be read."""

    def __init__(
        self,
        lost_keys: frozenset[str] = frozenset(),
        incomplete_libraries: frozenset[str] = frozenset(),
        describe_missing_type: MissingTypeDescriber | None = None,
        memory: LinkMemory | None = None,
    ) -> None:
        """Take what is known of files and libraries that could not be read, as for writing types out."""
        self._lost_keys = lost_keys
        self._incomplete_libraries = incomplete_libraries
        self._describe_missing_type = describe_missing_type
        self._memory = memory

    def lay_variant(
        self, root: MappingNode, variant: MappingEntry, find_architecture: Callable[[], Architecture]
    ) -> LaidVariant:
        """Return a project with a variant laid over it.

        `find_architecture` returns the architecture of the project before: only a variant with `without` asks for it.
        """
        body = mapping_values.get_body(variant)
        diagnostics: list[Diagnostic] = []
        laid = root
        node = body.entries.get("drop")
        for scalar in mapping_values.get_scalars(body, "drop") if node else ():
            laid = self._drop_path(laid, scalar, variant.key, diagnostics)
        changes = mapping_values.get_mapping(body, "changes")
        if changes.entries:
            targets = ChangeTargets(laid, changes, self._lost_keys, may_keep="without" in body.entries)
            diagnostics += targets.diagnostics
            laid, findings = lay_changes(laid, targets.sound, self._incomplete_libraries)
            diagnostics += [*findings, *find_incomplete(laid)]
        selector = mapping_values.get_scalar(body, "without")
        if selector is not None:
            architecture = find_architecture()
            # Where no section was touched that names elements, the architecture before is that of the tree at hand.
            is_same = all(laid.entries.get(section) is root.entries.get(section) for section in _NAMING_SECTIONS)
            laid = self._take_out(laid, selector, variant.key, changes, architecture, diagnostics, is_described=is_same)
        return LaidVariant(laid, tuple(diagnostics))

    def _drop_path(
        self, root: MappingNode, scalar: ScalarNode, variant_id: str, diagnostics: list[Diagnostic]
    ) -> MappingNode:
        section = scalar.text.partition(".")[0]
        if section in _KEPT_SECTIONS:
            message = f"no variant drops anything of `{section}`: it says what the project is"
            diagnostics.append(Diagnostic("missing-variant-part", message, scalar.span, element=variant_id))
            return root
        kept = drop_key(root, scalar.text)
        if not isinstance(kept, MissingKey):
            return kept
        # What could not be read may have had the key: nothing is said of it.
        if kept.word not in self._lost_keys:
            place = f"in `{'.'.join(kept.keys_before)}`" if kept.keys_before else "at the top of the project"
            near_keys = [key for key in kept.known_keys if kept.keys_before or key not in _KEPT_SECTIONS]
            help_line = did_you_mean(kept.word, near_keys) or "`drop` takes keys from the top: `nodes.laser.container`"
            diagnostics.append(
                Diagnostic(
                    "missing-variant-part",
                    f"there is no `{kept.word}` {place} to drop",
                    scalar.span,
                    help=help_line,
                    element=variant_id,
                )
            )
        return root

    def _take_out(  # noqa: PLR0913, PLR0917 - what laying knows by then
        self,
        root: MappingNode,
        selector: ScalarNode,
        variant_id: str,
        changes: MappingNode,
        architecture: Architecture,
        diagnostics: list[Diagnostic],
        *,
        is_described: bool,
    ) -> MappingNode:
        """Take out what a selector selects; `is_described` is whether the architecture is that of the root as it is."""
        evaluator = SelectorEvaluator(architecture)
        selected = select_left_out(selector, evaluator, variant_id)
        # A selector that finds nothing may mean what could not be read.
        if not architecture.partial:
            diagnostics += selected.diagnostics
        anew = frozenset(list_declared_anew(changes))
        leaves = frozenset(leaf for leaf in selected.components if anew.isdisjoint(_list_paths(leaf)))
        if not leaves and not selected.nodes:
            return root
        expansion = expand_project(root, self._incomplete_libraries, self._describe_missing_type)
        remover = ElementRemover(
            expansion, leaves, selected.nodes, self._memory, architecture if is_described else None
        )
        diagnostics += _find_lost_changes(changes, remover.removed.components)
        return prune_selectors(remover.remove_from(root), remover.removed, evaluator)


def _list_paths(component_id: str) -> Iterator[str]:
    """Yield a component and those around it, by complete ids."""
    yield component_id
    while component_id.count(".") > 1:
        component_id = component_id.rpartition(".")[0]
        yield component_id


def _find_lost_changes(changes: MappingNode, removed_components: frozenset[str]) -> Iterator[Diagnostic]:
    """Report what a variant writes to components that it takes out."""
    for group in mapping_values.get_mapping(changes, "groups"):
        pending = [(group.key, group)]
        while pending:
            holder_id, holder = pending.pop()
            for part in mapping_values.get_mapping(mapping_values.get_body(holder), "components"):
                part_id = f"{holder_id}.{part.key}"
                if part_id in removed_components:
                    yield Diagnostic(
                        "missing-variant-part",
                        f"the variant takes `{part_id}` out, and changes it",
                        part.key_span,
                        help="take the changes out, or write what it is in this variant: `outputs`, or `is`",
                        element=part_id,
                    )
                else:
                    pending.append((part_id, part))


def remove_variants(root: MappingNode) -> MappingNode:
    """Return a merged project without its variants: as it stands in one of them it has none."""
    return root.with_entries({e.key: e for e in root if e.key != "variants"})


_INSTANCE_KEYS = frozenset({"is", "same_as"})


class ChangeTargets:
    """Sorts what a variant writes: `sound` is what has a target, or declares something new."""

    def __init__(
        self, root: MappingNode, changes: MappingNode, lost_keys: frozenset[str], *, may_keep: bool = False
    ) -> None:
        """Take the project before the changes, the changes, and what could not be read: nobody knows of its elements.

        Components that are only named are kept from what the variant takes out, if it takes anything out (`may_keep`).
        """
        self.diagnostics: list[Diagnostic] = []
        self._root = root
        self._lost_keys = lost_keys
        self._may_keep = may_keep
        self.sound = changes.change_each(self._keep_sound)

    def _keep_sound(self, section: MappingEntry) -> MappingEntry:
        known = mapping_values.get_mapping(self._root, section.key)
        if section.key == "groups":
            return section.change_each(
                lambda group: self._keep_group(known, group) if self._is_known_group(known, group) else None
            )
        if section.key in SECTION_KINDS:
            for entry in mapping_values.get_body(section):
                if entry.key in known.entries and _is_stub(entry):
                    self._report_unchanged(entry, entry.key, f"`drop: [{section.key}.{entry.key}]`")
        if (kind := SECTION_KINDS.get(section.key, "")) in DECLARING_KEYS:
            return section.change_each(lambda entry: entry if self._is_sound(kind, known, entry) else None)
        return section

    def _is_sound(self, kind: str, known_body: MappingNode, entry: MappingEntry) -> bool:
        body = mapping_values.get_body(entry)
        is_new = entry.key not in known_body.entries and entry.key not in self._lost_keys
        if is_new and body.entries.keys().isdisjoint(DECLARING_KEYS[kind]):
            needed = " or ".join(f"`{key}`" for key in DECLARING_KEYS[kind][:2])
            self._report(entry, kind, entry.key, list(known_body.entries), f"a new one has {needed}")
            return False
        return True

    def _is_known_group(self, known_body: MappingNode, group: MappingEntry) -> bool:
        body = mapping_values.get_body(group)
        if group.key in known_body.entries or group.key in self._lost_keys or not body.entries:
            return True
        if "title" in body.entries or any(
            declares_itself(component.value) for component in mapping_values.get_mapping(body, "components")
        ):
            return True
        self._report(group, "group", group.key, list(known_body.entries), "a new one has a title or a component")
        return False

    def _keep_group(self, known_body: MappingNode, group: MappingEntry) -> MappingEntry:
        below = known_body.entries.get(group.key)
        return self._keep_parts(
            group, mapping_values.get_body(below) if below else mapping_values.EMPTY_MAPPING, group.key
        )

    def _keep_parts(self, holder: MappingEntry, known_body: MappingNode, holder_id: str) -> MappingEntry:
        """Return a group or component with the components inside that the project has, or that declare themselves."""
        body = mapping_values.get_body(holder)
        # What an instance has inside is in its type: writing out types judges that.
        if "components" not in body.entries or not _INSTANCE_KEYS.isdisjoint({*body.entries, *known_body.entries}):
            return holder
        known = mapping_values.get_mapping(known_body, "components")

        def keep_part(part: MappingEntry) -> MappingEntry | None:
            part_id = f"{holder_id}.{part.key}"
            if part.key in known.entries:
                if not self._may_keep and _is_stub(part):
                    self._report_unchanged(part, part_id, f"`without: {part_id}`")
                return self._keep_parts(part, mapping_values.get_body(known.entries[part.key]), part_id)
            if declares_itself(part.value) or _is_stub(part) or part.key in self._lost_keys:
                return part
            names = [f"{holder_id}.{name}" for name in known.entries]
            self._report(part, "component", part_id, names, "a new one has a title, a functionality, inputs or outputs")
            return None

        return holder.change_keys({"components": lambda parts: parts.change_each(keep_part)})

    def _report_unchanged(self, entry: MappingEntry, name: str, removal: str) -> None:
        self.diagnostics.append(
            Diagnostic(
                "missing-variant-part",
                f"a variant names `{name}` and changes nothing of it",
                entry.key_span,
                Severity.WARNING,
                help=f"to leave it out, write {removal} in the variant instead; else write what differs",
                element=name,
            )
        )

    def _report(self, entry: MappingEntry, kind: str, name: str, known_names: list[str], new_help: str) -> None:
        self.diagnostics.append(
            Diagnostic(
                "undeclared-element",
                f"a variant changes the {kind} `{name}`, which nothing declares",
                entry.key_span,
                help=did_you_mean(name, known_names) or new_help,
                element=name,
            )
        )


def _is_stub(part: MappingEntry) -> bool:
    return isinstance(part.value, MappingNode) and not part.value.entries and part.value.declares


def list_declared_anew(changes: MappingNode) -> Iterator[str]:
    """Yield the components that a variant declares, by complete ids, also such as the project has."""
    for group in mapping_values.get_mapping(changes, "groups"):
        yield from _list_declared(group, group.key)


def _list_declared(holder: MappingEntry, holder_id: str) -> Iterator[str]:
    for part in mapping_values.get_mapping(mapping_values.get_body(holder), "components"):
        body = mapping_values.get_body(part)
        part_id = f"{holder_id}.{part.key}"
        own_keys = body.with_entries({e.key: e for e in body if e.key != "components"})
        if _is_stub(part) or (own_keys.entries and declares_itself(own_keys)):
            yield part_id
        yield from _list_declared(part, part_id)
