"""Simulations of both languages in one workspace: generated, built, run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from tests.outside_tools import QUICK_START, find_tool, run_judge

BACKENDS = ("java", "python_simulation")
DOC_CHECKS = "-Xdoclint:all/protected,-missing"


def generate(project: Path, workspace: Path, *, backends: tuple[str, ...] = BACKENDS) -> list[str]:
    """Generate, and return what is said of what is left out."""
    checked = check_project(project)
    findings: list[str] = []
    for backend in backends:
        result = write_workspace(checked, OutputOptions(), backend, workspace)
        assert result.plan is not None, [each.message for each in result.findings]
        assert result.plan.conflicts == ()
        findings = [each.message for each in result.findings]
    return findings


def build_java(workspace: Path) -> None:
    """Compile as the README says, and find nothing to warn of."""
    words = (*(f"-J{each}" for each in QUICK_START), DOC_CHECKS, "@build.args")
    done = run_judge(find_tool("javac"), *words, cwd=workspace / "java")
    assert done.stdout + done.stderr == ""


def run_java(workspace: Path, main_class: str, *words: str) -> tuple[int, str, str]:
    """Return the exit status, the trace and what is said of mistakes."""
    command = [find_tool("java"), *QUICK_START, "-cp", "build", main_class, *words]
    done = subprocess.run(command, cwd=workspace / "java", capture_output=True, text=True, check=False)  # noqa: S603
    return done.returncode, done.stdout, done.stderr


def run_python(workspace: Path, *words: str) -> tuple[int, str, str]:
    """Run a module, and return the exit status, what it prints, and what is said of mistakes."""
    command = [sys.executable, "-B", "-m", *words]
    done = subprocess.run(command, cwd=workspace / "python", capture_output=True, text=True, check=False)  # noqa: S603
    return done.returncode, done.stdout, done.stderr
