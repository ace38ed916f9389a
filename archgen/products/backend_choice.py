"""Which text backend a name means, which verb makes it, and what it is made from. What pictures and documents take is not loaded for that."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Literal

from archgen.diagnostics import Diagnostic, did_you_mean
from archgen.emit import backend_manifests, file_tree
from archgen.emit.backend_manifests import CALLED_EMITTERS, Backend
from archgen.pipeline import CheckedProject
from archgen.products.output_options import OutputOptions
from archgen.products.trusted_backends import TrustedRevision, refuse_untrusted
from archgen.views.generation.generation_context import GenerationContext

BackendTarget = Literal["documents", "workspace", "file"]
_COMMANDS: Mapping[BackendTarget, str] = {
    "documents": "archgen build --backend {}",
    "workspace": "archgen generate {}",
    "file": "archgen export {}",
}
_TARGET_PHRASES: Mapping[BackendTarget, str] = {
    "documents": "documents",
    "workspace": "a workspace",
    "file": "a single file",
}


def choose_backends(
    checked_project: CheckedProject,
    names: Sequence[str],
    makes: BackendTarget,
    trusted_revision: TrustedRevision | None,
    *,
    other_outputs: Collection[str] = (),
) -> tuple[Backend, ...]:
    """Return the named text backends. Raise OutputError for unknown, broken or forbidden ones, and for others' verbs.

    Of the project's own backends those may run that `trusted_revision` allows; None allows all of them. `other_outputs`
    are further names that could have been meant.
    """
    if not names:
        return ()

    backends_by_name, problems = backend_manifests.find_backends(checked_project.root, names)
    if any(name not in backends_by_name or backends_by_name[name].emitter not in CALLED_EMITTERS for name in names):
        # All of them are read only for the message that lists them.
        backends_by_name, problems = backend_manifests.find_backends(checked_project.root)
    # Only manifests of backends that are asked for count; a broken one beside them must not stop the build.
    raise_problems([p for p in problems if any(f"backends/{name}/" in p.span.file for name in names)])
    for name in names:
        _refuse_unusable(backends_by_name, name, makes, other_outputs)
        if backends_by_name[name].from_project and trusted_revision is not None:
            refuse_untrusted(backends_by_name[name], trusted_revision)
    return tuple(backends_by_name[name] for name in dict.fromkeys(names))


def _refuse_unusable(
    backends_by_name: Mapping[str, Backend], name: str, makes: BackendTarget, other_outputs: Collection[str]
) -> None:
    """Raise OutputError unless there is a text backend of this name that makes what the verb is for."""
    usable_names = list(other_outputs) + [
        backend_id
        for backend_id, backend in backends_by_name.items()
        if backend.emitter in CALLED_EMITTERS and backend.makes == makes
    ]
    backend = backends_by_name.get(name)
    if backend is None or backend.emitter not in CALLED_EMITTERS:
        msg = f"there is no {'output' if other_outputs else 'text backend'} `{name}`"
        raise file_tree.OutputError(msg, did_you_mean(name, usable_names) or f"there are {', '.join(usable_names)}")
    if backend.makes != makes:
        msg = f"the backend `{name}` makes {_TARGET_PHRASES[backend.makes]}, not {_TARGET_PHRASES[makes]}"
        raise file_tree.OutputError(msg, f"`{_COMMANDS[backend.makes].format(name)}` makes it")
    # `PRODUCTS` are written into the same folder, and `--only` names both.
    if backend.from_project and _is_product(name):
        msg = f"the backend `{name}` is called as an output of archgen itself"
        raise file_tree.OutputError(msg, "give it another `id`, and its folder the same name")


def _is_product(name: str) -> bool:
    from archgen.products.product_table import PRODUCTS

    return name in PRODUCTS


def raise_problems(problems: Sequence[Diagnostic]) -> None:
    """Raise OutputError with all problems, if there are any."""
    if problems:
        message = "; ".join(f"{problem.span}: {problem.message}" for problem in problems)
        raise file_tree.OutputError(message, problems[0].help)


def make_generation_context(
    checked_project: CheckedProject, options: OutputOptions, backend: Backend
) -> GenerationContext:
    """Return the context for a backend; nothing is packed before a view asks for it."""

    def pack() -> Mapping[str, Any]:
        from archgen.checking.checked_packing import pack_checked_project

        return pack_checked_project(checked_project).data

    selection = options.selection
    return GenerationContext(
        checked_project.architecture,
        selection.components if selection else None,
        selection.nodes if selection else None,
        options=backend.options,
        backend=backend.id,
        level=options.level or "implementation",
        types_only=options.types_only,
        pack_project=pack,
    )
