"""A workspace made by a backend: its files are rendered, what the folder holds is compared, then all is written or nothing."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from archgen.diagnostics import NO_SPAN, Diagnostic, Severity, did_you_mean
from archgen.emit.backend_manifests import Backend
from archgen.emit.file_tree import OutputError, refuse_file
from archgen.emit.workspace import workspace_writing
from archgen.emit.workspace.disk_files import DiskReader, GeneratedFile, fold_file_path
from archgen.emit.workspace.run_record import (
    find_former_project,
    read_other_own_files,
    read_other_records,
    read_run_record,
    take_over_runs,
)
from archgen.emit.workspace.workspace_plan import STALE, FileStep, KnownFits, UserChoices, WorkspacePlan, plan_workspace
from archgen.model.architecture import ProjectInfo
from archgen.pipeline import CheckedProject
from archgen.products.backend_choice import choose_backends, make_generation_context, raise_problems
from archgen.products.output_options import OutputOptions, refuse_leaving_links
from archgen.products.report_cache import cache_folder
from archgen.products.trusted_backends import refuse_untrusted_pass
from archgen.views.generation import find_view_maker, is_shipped_view, make_generation_views
from archgen.views.generation.architecture_needs import find_unmet_needs
from archgen.views.generation.generation_context import (
    NOT_GENERATED,
    GenerationContext,
    give_model_paths,
    tell_left_out,
)
from archgen.views.generation.model_paths import index_model_paths, write_model_paths


@dataclass(frozen=True, slots=True)
class WorkspaceRequest:
    """What of a workspace is asked for: a host alone, single files taken or kept, other options, nothing but a look."""

    host: str | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    overwritten: Sequence[str] = ()
    kept: Sequence[str] = ()
    only_look: bool = False
    removes_unmade: bool = True
    """Whether files go that are no longer made."""
    usual_options: Mapping[str, str] = field(default_factory=dict)
    """What the project says of options that are not asked for otherwise."""
    leaving: Collection[str] = ()
    """Files that other backends take away before this one is made."""
    only_clears: bool = False
    """Whether only what is no longer made is taken away."""
    waits_with_orphans: bool = False
    """Whether nothing is done where own code loses its place: another backend may make the next one for it first."""
    former_project: str = ""
    """The id that the project had before, or its own one where what another project has here is none of its."""


@dataclass(frozen=True, slots=True)
class WorkspaceResult:
    """What was done, or would be: the folder, the plan, and what could not be generated."""

    folder: Path
    plan: WorkspacePlan | None
    """None where nothing is written, since the findings say that it would be wrong."""
    findings: tuple[Diagnostic, ...] = ()
    is_in_the_way: bool = False
    """Whether another backend has files where this one makes some, or is to make what takes the place of own code."""

    @property
    def stale_steps(self) -> tuple[FileStep, ...]:
        """The files that are not as the architecture says, but for those that are told as conflicts."""
        return tuple(each for each in self.plan.steps if each.verb in STALE) if self.plan else ()

    @property
    def is_complete(self) -> bool:
        """Whether the workspace is now what the architecture says, and the user's own code fits."""
        has_errors = any(each.effective_severity is Severity.ERROR for each in self.findings)
        return self.plan is not None and not (self.plan.conflicts or self.plan.has_unfit_code or has_errors)


def write_workspace(
    checked_project: CheckedProject,
    options: OutputOptions,
    backend_name: str,
    target: Path | None = None,
    request: WorkspaceRequest = WorkspaceRequest(),
) -> WorkspaceResult:
    """Write the workspace of a backend into a folder, by default its own among the outputs.

    Raise OutputError where no backend of this name makes a workspace, where its templates fail, and where the folder
    cannot be used.
    """
    (backend,) = choose_backends(checked_project, (backend_name,), "workspace", options.trusted_revision)
    backend = _set_options(backend, {**request.usual_options, **request.options})
    folder = target or checked_project.output_folder / backend.id
    refuse_leaving_links(checked_project, folder)
    if backend.passes:
        checked_project, options, errors = _run_passes(checked_project, options, backend)
        if errors:
            return WorkspaceResult(folder, None, errors)
    files, findings = _render_files(checked_project, options, backend, request.host)
    if files is None:
        return WorkspaceResult(folder, None, findings)
    clashes = () if request.only_clears else tuple(_find_clashes(files, backend, folder, request.leaving))
    if clashes:
        return WorkspaceResult(folder, None, (*findings, *clashes), is_in_the_way=True)
    project = checked_project.architecture.project
    run = _name_run(checked_project, options, request.host)
    request = replace(request, removes_unmade=request.removes_unmade and not checked_project.has_errors)
    if request.former_project not in {"", project.id}:
        findings = (*findings, *_find_unknown_id(project, request.former_project, folder, backend))
    try:
        plan = _write_files(files, backend, folder, run, request)
    except _FormerProjectError as error:
        return WorkspaceResult(folder, None, (*findings, _ask_for_former_id(project, error.former_project, folder)))
    if request.waits_with_orphans and plan.has_orphans:
        return WorkspaceResult(folder, None, findings, is_in_the_way=True)
    return WorkspaceResult(folder, plan, findings)


def write_workspaces(
    checked_project: CheckedProject,
    options: OutputOptions,
    requests: Mapping[str, WorkspaceRequest],
    target: Path | None = None,
) -> Iterator[tuple[str, WorkspaceResult]]:
    """Write the workspaces of several backends: one waits for those whose files are in its way, and may leave.

    Where they wait for one another, since they change places, one first takes away what it no longer makes.
    """
    waiting, leaving, has_waited, has_cleared = [*requests], set[str](), set[str](), set[str]()
    while waiting:
        name = waiting.pop(0)
        request = replace(requests[name], leaving=frozenset(leaving))
        request = replace(request, waits_with_orphans=bool(waiting) and name not in has_cleared)
        result = write_workspace(checked_project, options, name, target, request)
        if result.is_in_the_way and waiting and name not in has_waited:
            waiting.append(name)
            has_waited.add(name)
            continue
        if result.is_in_the_way and name not in has_cleared:
            waiting.append(name)
            has_cleared.add(name)
            request = replace(request, only_clears=True, waits_with_orphans=False)
            cleared = write_workspace(checked_project, options, name, target, request)
            if not (cleared.plan and cleared.plan.removals):
                continue
            # What could not be generated is said by the run that generates.
            result = replace(cleared, findings=())
        leaving |= {*result.plan.removals, *result.plan.vanished} if result.plan else set()
        yield name, result


def _run_passes(
    checked_project: CheckedProject, options: OutputOptions, backend: Backend
) -> tuple[CheckedProject, OutputOptions, tuple[Diagnostic, ...]]:
    """Return a project behind the passes of a backend, with what is selected of it, and the errors that are new."""
    # Imported here: hardly any backend has passes.
    from archgen.passes import UnknownPassError
    from archgen.passes.patterns.pattern_registry import find_known_passes
    from archgen.pipeline import transform_project
    from archgen.products.project_views import select_elements

    known_passes = find_known_passes(checked_project.loaded_project)
    for name in backend.passes:
        # A backend that is trusted may name a pass that is not.
        if name in known_passes.own_files and options.trusted_revision is not None:
            files = checked_project.loaded_project.files
            refuse_untrusted_pass(name, known_passes.own_files[name], files, options.trusted_revision)
    try:
        transformed_project = transform_project(checked_project, backend.passes, known_passes.passes)
    except UnknownPassError as error:
        msg = f"the backend `{backend.id}` cannot be used: {error}"
        raise OutputError(msg, f"mend `passes` in {backend.name}/backend.yaml") from None
    known_errors = {(each.rule, each.message) for each in checked_project.findings}
    errors = tuple(
        each
        for each in transformed_project.findings
        if each.effective_severity is Severity.ERROR and (each.rule, each.message) not in known_errors
    )
    if options.selection is not None and not errors:
        # Passes change ids: what the selector names is looked up in what they made.
        selection, problems = select_elements(transformed_project, options.selector_text)
        wrong = [problem for problem in problems if problem.severity == "error"]
        if wrong:
            msg = f"{wrong[0].message}, behind the passes of the backend `{backend.id}` ({', '.join(backend.passes)})"
            raise OutputError(msg, wrong[0].help)
        options = replace(options, selection=selection)
    return transformed_project, options, errors


def _set_options(backend: Backend, options: Mapping[str, str]) -> Backend:
    """Return a backend with other values for some of its options. Raise OutputError for one that it has not."""
    for name in options:
        known_names = [each for each, value in backend.options.items() if isinstance(value, str)]
        if name not in known_names:
            msg = f"the backend `{backend.id}` has no option `{name}`"
            known = f"it has {', '.join(known_names)}" if known_names else "it has none"
            raise OutputError(msg, did_you_mean(name, known_names) or known)
    for name, value in options.items():
        known_values = backend.choices.get(name, ("", "1", "2") if name == "ros" else (value,))
        if value not in known_values:
            named = [f"`{each}`" for each in known_values if each]
            msg = f"the option `{name}` of the backend `{backend.id}` is {' or '.join(named)}, not `{value}`"
            help_line = "another backend makes that: `archgen list --of backends`" if len(known_values) == 1 else None
            raise OutputError(msg, did_you_mean(value, known_values) or help_line or "leave it out for the usual one")
    return replace(backend, options={**backend.options, **options})


def _render_files(
    checked_project: CheckedProject, options: OutputOptions, backend: Backend, host: str | None
) -> tuple[tuple[GeneratedFile, ...] | None, tuple[Diagnostic, ...]]:
    """Return the files of a backend, and what could not be generated; no files where its needs do not hold."""
    from archgen.emit import text
    from archgen.emit.text.kept_answers import open_answer_store

    context = replace(
        make_generation_context(checked_project, options, backend),
        host=host,
        selector=options.selector_text if options.selection else "",
    )
    unmet_needs = tuple(find_unmet_needs(context, backend.needs))
    if unmet_needs:
        return None, unmet_needs
    paths = index_model_paths(context.architecture)
    with give_model_paths(paths):
        views, findings = _make_views(checked_project, options, backend, context)
    views = {name: view if is_shipped_view(name) else write_model_paths(view, paths) for name, view in views.items()}
    places = {path: place for place, path in paths.items()}
    limits = text.DEFAULT_LIMITS.scale_to(context.element_count)
    store = open_answer_store(cache_folder())
    files, problems = text.render_workspace(backend, views, places, limits, store)
    raise_problems(problems)
    return files, findings


def _make_views(
    checked_project: CheckedProject, options: OutputOptions, backend: Backend, context: GenerationContext
) -> tuple[Mapping[str, object], tuple[Diagnostic, ...]]:
    """Return the views of a backend. What documents are made from is loaded only for one that asks for it."""
    if all(map(find_view_maker, backend.views)):
        return make_generation_views(context, backend.views)
    from archgen.products.backend_products import make_backend_views
    from archgen.products.product_inputs import ProductInputs

    return make_backend_views(ProductInputs(checked_project, options), backend, context)


def _name_run(checked_project: CheckedProject, options: OutputOptions, host: str | None) -> str:
    """Name what a run makes: the project, and the part of it that is asked for. A variant changes what its files say."""
    words = [checked_project.architecture.project.id]
    if options.selector_text:
        words += ["--select", " ".join(options.selector_text.split())]
    if host:
        words += ["--host", host]
    return " ".join(words)


def _find_clashes(
    files: Sequence[GeneratedFile], backend: Backend, folder: Path, leaving: Collection[str]
) -> Iterator[Diagnostic]:
    """Yield the first file that another backend makes in a folder, too."""
    other_backends = read_other_records(folder, backend.id)
    for file in files if other_backends else ():
        if file.path not in leaving and (other := other_backends.get(fold_file_path(file.path))):
            yield tell_left_out(
                f"`{file.path}` is made by the backend `{other}` in this folder, and by `{backend.id}`",
                NO_SPAN,
                help_line=f"`archgen generate {other}` takes it away if it is not made there any more; else give another folder "
                f"with `-o`, or remove `.archgen/{other}.json` if that one is not used here any more",
            )
            return


class _FormerProjectError(Exception):
    """A folder has code of somebody's own that was made for another project, or for this one under another id."""

    def __init__(self, former_project: str) -> None:
        super().__init__(former_project)
        self.former_project = former_project


def _ask_for_former_id(project: ProjectInfo, former: str, folder: Path) -> Diagnostic:
    return tell_left_out(
        f"{folder} has code of somebody's own that was made for the project `{former}`: `{project.id}` would begin it anew beside it",
        project.at,
        help_line=f"is it this project under its former id, `--was {former}` takes it over and says what of the code moves where; "
        f"are they two projects, `--was {project.id}` leaves all of `{former}` as it is",
    )


def _find_unknown_id(project: ProjectInfo, former: str, folder: Path, backend: Backend) -> Iterator[Diagnostic]:
    files = read_run_record(folder, backend.id).files.values()
    known_ids = {run.partition(" ")[0] for file in files for run in file.runs}
    if known_ids and former not in known_ids:
        message = f"nothing that `{backend.id}` made in {folder} was made for `{former}`: `--was` changes nothing of it"
        yield Diagnostic(
            NOT_GENERATED.name, message, project.at, Severity.WARNING, help=did_you_mean(former, sorted(known_ids))
        )


def _write_files(
    files: Sequence[GeneratedFile], backend: Backend, folder: Path, run: str, request: WorkspaceRequest
) -> WorkspacePlan:
    """Plan, and unless only a look is asked for, do what is planned."""
    refuse_file(folder)
    try:
        if request.only_look:
            return _plan_files(files, backend, folder, run, request)
        with workspace_writing.lock_workspace(folder):
            plan = _plan_files(files, backend, folder, run, request)
            if not (request.waits_with_orphans and plan.has_orphans):
                workspace_writing.carry_out(plan, folder)
            return plan
    except OSError as error:
        msg = f"cannot write {error.filename or folder}: {error.strerror or error}"
        raise OutputError(msg, "no file is half written; run this again when that is mended") from error


def _plan_files(
    files: Sequence[GeneratedFile], backend: Backend, folder: Path, run: str, request: WorkspaceRequest
) -> WorkspacePlan:
    record, project_id = read_run_record(folder, backend.id), run.partition(" ")[0]
    former = find_former_project(record, project_id, frozenset(file.path for file in files))
    if former and request.former_project not in {former, project_id}:
        raise _FormerProjectError(former)
    if request.former_project:
        record = take_over_runs(record, request.former_project, project_id)
    known_paths = {*record.files, *(file.path for file in files)}
    fits = KnownFits(cache_folder(), folder, backend.id)
    choices = UserChoices(
        _find_named_paths(request.overwritten, folder, known_paths),
        _find_named_paths(request.kept, folder, known_paths),
        request.removes_unmade,
        request.only_clears,
        fits,
        lambda: read_other_own_files(folder, backend.id),
    )
    plan = plan_workspace(record, run, files, DiskReader(folder, request.leaving), choices)
    fits.keep()
    return plan


def _find_named_paths(names: Sequence[str], folder: Path, known_paths: set[str]) -> frozenset[str]:
    """Return the files that somebody names: relative to the workspace, or from where he stands; a folder names all below."""
    found_paths = set[str]()
    for name in names:
        spellings = [name.replace("\\", "/").removeprefix("./").rstrip("/")]
        with contextlib.suppress(ValueError):
            spellings.append(Path(name).resolve().relative_to(folder.resolve()).as_posix())
        named_paths = {
            path
            for path in known_paths
            if any(each in {path, "."} or path.startswith(f"{each}/") for each in spellings)
        }
        if not named_paths:
            msg = f"this backend makes no file `{name}` here"
            raise OutputError(msg, did_you_mean(name, sorted(known_paths)) or "`--dry-run` shows all files")
        found_paths |= named_paths
    return frozenset(found_paths)
