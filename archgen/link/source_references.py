"""Resolve what ports name as their sources where components hold components: from the inside to the outside.

What stands beside the writer wins, then what stands around it, then its group, then the rest. From outside only the ports
of a composed component are seen; from inside of a component type nothing around it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from archgen.diagnostics import Label, did_you_mean
from archgen.link.element_outline import ElementOutline
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.path_resolver import MAX_LISTED, NO_MATCH, ElementRef, PathMatch, PathResolver
from archgen.syntax.yaml_tree import ScalarNode

SOURCE_KINDS = ("group", "component", "output")
SELF = "self"
"""The component around the writer, in references."""
_PORT_PATH_LENGTH = 2


class SourceReferences:
    """Resolves the sources of ports in a project with composed components."""

    def __init__(self, outline: ElementOutline, resolver: ReferenceResolver) -> None:
        """Take what the project declares, and the resolver that words what is wrong."""
        self._outline = outline
        self._resolver = resolver
        self._parents = outline.expansion.parents if outline.expansion else {}
        self._closed_ids = outline.expansion.instances if outline.expansion else {}
        self._output_owners: dict[str, dict[str, list[str]]] = {}

    def resolve_source(self, reference: ScalarNode, writer_id: str) -> ElementRef | None:
        """Return what a reference of a component means; None, and a diagnostic, if that is not clear."""
        inner_id, shell_id = writer_id, self._parents.get(writer_id)
        if reference.text.startswith(f"{SELF}."):
            return self._resolve_self(reference, shell_id, writer_id)
        while shell_id is not None:
            match = self._match_inside(shell_id, reference.text, inner_id)
            if match.count:
                return self._settle_match(reference, match, writer_id)
            if shell_id in self._closed_ids:
                self._diagnose_closed(reference, shell_id, writer_id)
                return None
            inner_id, shell_id = shell_id, self._parents.get(shell_id)
        return self._resolve_outside(reference, writer_id)

    def resolve_given(self, reference: ScalarNode, shell_id: str) -> ElementRef | None:
        """Return what a composed component passes on at an output: an output directly inside, or an input of its own."""
        if reference.text.startswith(f"{SELF}."):
            return self._resolve_self(reference, shell_id, shell_id)
        match = self._match_inside(shell_id, reference.text, shell_id)
        if match.count:
            return self._settle_match(reference, match, shell_id)
        children = self._outline.shells[shell_id].children
        words = [f"{child.rpartition('.')[2]}.{name}" for child in children for name in self._outline.outputs[child]]
        self._resolver.report(
            "unknown-reference",
            f"no output `{reference.text}` directly inside of `{shell_id}`",
            reference.span,
            help_line=did_you_mean(reference.text, words)
            or "name an output of a component inside, or `self.` and an input",
            element=shell_id,
        )
        return None

    def _match_inside(self, shell_id: str, path: str, inner_id: str) -> PathMatch:
        """Match a path among what stands directly inside of a composed component, without the writer and what holds it."""
        words = path.split(".")
        child = f"{shell_id}.{words[0]}"
        is_child = self._parents.get(child) == shell_id
        if len(words) > 1:
            is_output = is_child and len(words) == _PORT_PATH_LENGTH and words[1] in self._outline.outputs[child]
            return _make_match([ElementRef("output", f"{child}.{words[1]}")] if is_output else [])
        matches = [ElementRef("component", child)] if is_child and child != inner_id else []
        owners = self._list_output_owners(shell_id).get(path, ())
        matches += [ElementRef("output", f"{owner}.{path}") for owner in owners if owner != inner_id]
        return _make_match(matches)

    def _list_output_owners(self, shell_id: str) -> dict[str, list[str]]:
        """Return what stands directly inside of a composed component, by the names of its outputs."""
        if shell_id not in self._output_owners:
            owners: dict[str, list[str]] = {}
            for child in self._outline.shells[shell_id].children:
                for name in self._outline.outputs[child]:
                    owners.setdefault(name, []).append(child)
            self._output_owners[shell_id] = owners
        return self._output_owners[shell_id]

    def _settle_match(self, reference: ScalarNode, match: PathMatch, writer_id: str) -> ElementRef | None:
        if match.unique_element is None:
            self._resolver.report_ambiguous(reference, match, writer_id)
            return None
        self._resolver.tell(reference.span, reference.text, *match.unique_element, writer_id)
        return match.unique_element

    def _resolve_self(self, reference: ScalarNode, shell_id: str | None, writer_id: str) -> ElementRef | None:
        name = reference.text.removeprefix(f"{SELF}.")
        if shell_id is not None and name in self._outline.inputs[shell_id]:
            target = ElementRef("input", f"{shell_id}.{name}")
            self._resolver.tell(reference.span, reference.text, *target, writer_id)
            return target
        if shell_id is None:
            message = f"`{reference.text}` names the component around `{writer_id}`, but there is none"
            help_line: str | None = "name the output that it comes from"
        elif self._resolver.damaged_elements and shell_id in self._resolver.damaged_elements:
            return None
        else:
            message = f"`{shell_id}` has no input `{name}`"
            help_line = (
                did_you_mean(name, self._outline.inputs[shell_id])
                or "`self` means the component around: name one of its inputs"
            )
        self._resolver.report("unknown-reference", message, reference.span, help_line=help_line, element=writer_id)
        return None

    def _resolve_outside(self, reference: ScalarNode, writer_id: str) -> ElementRef | None:
        path = reference.text
        match = self._open_names.resolve_path(path, SOURCE_KINDS, component_id=writer_id)
        inner_target = None if match.count else self._find_inside(path)
        if inner_target is not None:
            self._warn_inside(reference, path, writer_id)
            self._resolver.tell(reference.span, path, *inner_target, writer_id)
            return inner_target
        inside = NO_MATCH if match.count else self._resolver.names.resolve_path(path, ("component", "output"))
        if inside.count:
            self._diagnose_inside(reference, inside.elements[0], writer_id)
            return None
        target = self._resolver.resolve_reference(reference, SOURCE_KINDS, writer_id, writer_id, names=self._open_names)
        if target is not None and self._is_around(target, writer_id):
            message = f"`{path}` is a component around `{writer_id}`"
            help_line = "a reference never means what it stands in: `self.` and a name is an input of that component"
            self._resolver.report("unknown-reference", message, reference.span, help_line=help_line, element=writer_id)
            return None
        return target

    def _is_around(self, target: ElementRef, writer_id: str) -> bool:
        component_id = target.id.rpartition(".")[0] if target.kind == "output" else target.id
        shell_id = self._parents.get(writer_id)
        while shell_id is not None and shell_id != component_id:
            shell_id = self._parents.get(shell_id)
        return shell_id is not None

    def _find_inside(self, path: str) -> ElementRef | None:
        """Return what a complete path names inside of a composed component."""
        spans = self._resolver.spans
        kind = next((kind for kind in ("component", "output") if path in spans[kind]), None)
        return ElementRef(kind, path) if kind else None

    def _diagnose_inside(self, reference: ScalarNode, target: ElementRef, writer_id: str) -> None:
        self._resolver.suspect_ids.add(target.id)
        self._resolver.report(
            "unknown-reference",
            f"`{reference.text}` lies inside of a composed component: only its ports are seen from here",
            reference.span,
            labels=(Label(self._resolver.spans[target.kind][target.id], f"`{target.id}`"),),
            help_line=f"give it on at an output of the composed component, or write all of its path: `{target.id}`",
            element=writer_id,
        )

    def _warn_inside(self, reference: ScalarNode, path: str, writer_id: str) -> None:
        ids = path.split(".")
        outer_paths = (".".join(ids[:length]) for length in range(1, len(ids)))
        shell_id = next(each for each in outer_paths if each in self._outline.shells)
        self._resolver.report(
            "reaches-inside",
            f"`{path}` lies inside of `{shell_id}`, whose ports are what others may count on",
            reference.span,
            labels=(Label(self._outline.shells[shell_id].entry.key_span, "composed"),),
            help_line=f"give it on: an output of `{shell_id}` with `from`",
            element=writer_id,
        )

    def _diagnose_closed(self, reference: ScalarNode, shell_id: str, writer_id: str) -> None:
        origin = self._closed_ids[shell_id]
        outside = self._open_names.resolve_path(reference.text, SOURCE_KINDS)
        children = [child.rpartition(".")[2] for child in self._outline.shells[shell_id].children]
        type_name = origin.expression.name
        if outside.count:
            rule, message = (
                "reaches-outside",
                f"inside of the type `{type_name}`, `{reference.text}` means something outside of it",
            )
            help_line: str | None = f"give `{type_name}` an input and name it here: `self.` and its name"
        else:
            rule, message = "unknown-reference", f"nothing inside of the type `{type_name}` is named `{reference.text}`"
            help_line = did_you_mean(reference.text.partition(".")[0], children)
        self._resolver.report(rule, message, reference.span, help_line=help_line, element=writer_id)

    @cached_property
    def _open_names(self) -> PathResolver:
        """What can be named from everywhere: groups, what stands directly in them, and its outputs."""
        open_ids = [
            component_id for component_id in self._resolver.spans["component"] if component_id not in self._parents
        ]
        return PathResolver(
            {
                "group": self._outline.groups,
                "component": open_ids,
                "output": [f"{name}.{output}" for name in open_ids for output in self._outline.outputs[name]],
            }
        )


def _make_match(elements: Sequence[ElementRef]) -> PathMatch:
    return PathMatch(tuple(elements[:MAX_LISTED]), len(elements))
