"""In which order variants are laid over the project: what one is built on comes first, each once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link import mapping_values
from archgen.model.variant import BASE_NAME, Variant
from archgen.syntax.yaml_tree import MappingNode, ScalarNode


def list_steps(variants: Mapping[str, Variant], names: Sequence[str]) -> tuple[str, ...]:
    """Return the variants that are laid over the project, one after the other, for it to stand in some of them.

    Each stands behind those that it is built on, and once. Circles are cut, and unknown names left out: both are
    reported where they are written.
    """
    steps: dict[str, None] = {}
    open_names: set[str] = set()
    # Without recursion: a stranger's file may build ten thousand variants on one another.
    pending: list[tuple[str, bool]] = [(name, False) for name in reversed(names)]
    while pending:
        name, is_left = pending.pop()
        if is_left:
            open_names.discard(name)
            steps[name] = None
        elif name in variants and name not in steps and name not in open_names:
            open_names.add(name)
            pending.append((name, True))
            pending += [(each, False) for each in reversed(variants[name].of)]
    return tuple(steps)


def check_variant_order(root: MappingNode, lost_keys: frozenset[str]) -> Iterator[Diagnostic]:
    """Report variants that are built on what is no variant, and those that are built on themselves."""
    references = {
        name: mapping_values.get_scalars(body, "of")
        for name, _, body in mapping_values.iterate_elements(root, "variants")
    }
    for name, scalars in references.items():
        for scalar in scalars:
            if scalar.text not in references and scalar.text not in lost_keys:
                yield _diagnose_unknown(scalar, name, [each for each in references if each != name])
    reported_names: set[str] = set()
    for name in references:
        circle = _find_circle(references, name) if name not in reported_names else []
        if circle and reported_names.isdisjoint(circle):
            reported_names.update(circle)
            yield _diagnose_circle(references, circle)


def _diagnose_unknown(scalar: ScalarNode, name: str, known_names: Sequence[str]) -> Diagnostic:
    help_line = did_you_mean(scalar.text, known_names) or "`of` names variants of this project"
    if scalar.text == BASE_NAME:
        help_line = "every variant is built on the project itself: leave it out"
    return Diagnostic("unknown-variant", f"no variant named `{scalar.text}`", scalar.span, help=help_line, element=name)


def _find_circle(references: Mapping[str, Sequence[ScalarNode]], name: str) -> list[str]:
    """Return the way from a variant back to itself through what it is built on, itself first; empty where there is none."""
    came_from: dict[str, str] = {}
    pending = [name]
    while pending:
        current = pending.pop()
        for scalar in references[current]:
            if scalar.text == name:
                way = [current]
                while way[-1] != name:
                    way.append(came_from[way[-1]])
                return way[::-1]
            if scalar.text in references and scalar.text not in came_from:
                came_from[scalar.text] = current
                pending.append(scalar.text)
    return []


def _diagnose_circle(references: Mapping[str, Sequence[ScalarNode]], circle: list[str]) -> Diagnostic:
    places = [
        next(scalar for scalar in references[name] if scalar.text == following)
        for name, following in zip(circle, [*circle[1:], circle[0]], strict=True)
    ]
    shown_names = [f"`{name}`" for name in circle[:8]]
    message = (
        f"the variant `{circle[0]}` is built on itself"
        if len(circle) == 1
        else f"the variants {join_words([*shown_names, *(['others'] if len(circle) > len(shown_names) else [])], 'and')} are built on one another"
    )
    return Diagnostic(
        "circular-variant",
        message,
        places[0].span,
        labels=tuple(
            Label(scalar.span, f"`{name}` is built on it")
            for name, scalar in list(zip(circle, places, strict=True))[1:8]
        ),
        help="take one of them out of `of`",
        element=circle[0],
    )
