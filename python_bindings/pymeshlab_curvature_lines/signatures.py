# What help() and editors show of the filters when a program runs: the stub that type checkers read, once more.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Signatures and descriptions of the filters, out of the package's own stub."""

from __future__ import annotations

import ast
from inspect import Parameter, Signature
from pathlib import Path
from typing import NamedTuple


class Described(NamedTuple):
    signature: Signature
    text: str  # what the filter does, and every parameter


def filters_of(stub: Path) -> dict[str, Described]:
    """The methods of the stub's class, by name."""
    module = ast.parse(stub.read_text(encoding="utf-8"))
    (methods,) = (node.body for node in module.body if isinstance(node, ast.ClassDef))
    return {
        node.name: Described(_signature(node), ast.get_docstring(node) or "")
        for node in methods
        if isinstance(node, ast.FunctionDef)
    }


def _signature(method: ast.FunctionDef) -> Signature:
    parameters = [Parameter("self", Parameter.POSITIONAL_OR_KEYWORD)]
    for argument, default in zip(method.args.kwonlyargs, method.args.kw_defaults, strict=True):
        parameters.append(
            Parameter(
                argument.arg,
                Parameter.KEYWORD_ONLY,
                default=Parameter.empty if default is None else ast.literal_eval(default),
                annotation=Parameter.empty if argument.annotation is None else ast.unparse(argument.annotation),
            )
        )
    return Signature(parameters, return_annotation=ast.unparse(method.returns) if method.returns else Signature.empty)
