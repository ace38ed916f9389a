"""What a revision says about the project's own backends."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from archgen.emit.backend_manifests import find_backends
from archgen.products.trusted_backends import (
    TrustedRevision,
    UntrustedBackendError,
    read_trusted_revision,
    refuse_untrusted,
)
from tests import repositories

PROJECT = "archgen: 1\nproject: {id: x}\nreview: {backends: [mine]}\n"
MANIFEST = "{id: mine, title: M, emitter: text, view: record, files: [{template: t, path: t}]}"


def test_a_backend_is_trusted_by_name_and_content(tmp_path: Path) -> None:
    files: dict[str, str | bytes] = {"archgen.yaml": PROJECT, "backends/mine/backend.yaml": MANIFEST}
    folder = repositories.repository(tmp_path / "robot", files)
    backend = find_backends(folder)[0]["mine"]
    trusted_revision = read_trusted_revision(folder, "main")
    assert trusted_revision.allowed_names == ("mine",)
    refuse_untrusted(backend, trusted_revision)
    for distrusted in (replace(trusted_revision, allowed_names=()), TrustedRevision("main", ("mine",))):
        with pytest.raises(UntrustedBackendError, match="the revision that is trusted does not name it"):
            refuse_untrusted(backend, distrusted)
    (backend.folder / "more").touch()
    with pytest.raises(UntrustedBackendError, match="differs from the one in `main`: `backends/mine/more`"):
        refuse_untrusted(backend, trusted_revision)


def test_a_project_that_is_new_is_allowed_nothing(tmp_path: Path) -> None:
    folder = repositories.repository(tmp_path, {"other": ""})
    (folder / "archgen.yaml").write_text(PROJECT)
    assert read_trusted_revision(folder, "main") == TrustedRevision("main")
