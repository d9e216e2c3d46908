"""Exceptions, and the messages of the compiler."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


class Error(Exception):
    """The scene cannot do what was asked for. The text says why."""


class ArgumentError(Error, ValueError):
    """A param, an option or another argument has a value that it does not take."""


class MachineError(Error):
    """The machine cannot do it: there is no GPU, or not enough memory."""


class CompileError(Error):
    """The source has errors.

    The text is what ``sdfc check`` prints: each message with its code, its location in the source,
    and what to write instead.
    """

    diagnostics: tuple[Diagnostic, ...]
    """The errors and warnings as data."""

    def __init__(self, message: str, diagnostics: tuple[Diagnostic, ...] = ()) -> None:
        super().__init__(message)
        self.diagnostics = diagnostics


@dataclass(frozen=True)
class Diagnostic:
    """An error or a warning. Lines and columns count from 1."""

    code: str
    """The code, such as ``E0201``."""
    severity: str
    """``error`` or ``warning``."""
    message: str
    """The problem, in one sentence."""
    file: str
    """The name of the file."""
    line: int
    """The line of the first character."""
    column: int
    """The column of the first character."""
    end_line: int
    """The line of the end."""
    end_column: int
    """The column after the last character."""
    help: str
    """Suggestions, one per line."""
    fixes: tuple[dict[str, Any], ...]
    """Changes of the source that fix the problem: ``title``, and a list of ``edits``."""

    def __str__(self) -> str:
        location = f"{self.file}:{self.line}:{self.column}"
        return f"{location}: {self.severity}[{self.code}]: {self.message}"


def diagnostics(rows: list[dict[str, Any]]) -> tuple[Diagnostic, ...]:
    """Converts the rows of ``sdfc check --json``; keys of later versions are left out."""
    names = Diagnostic.__dataclass_fields__
    stated = ({name: row[name] for name in names} for row in rows)
    return tuple(Diagnostic(**{**row, "fixes": tuple(row["fixes"])}) for row in stated)
