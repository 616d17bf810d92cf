"""The last part of a derivation: parameters, natural frequencies and modes as numbers."""

from __future__ import annotations

import numpy as np
import sympy as sp

from railride import modal
from railride.bodies import slender_beam
from railride.markup import Block, Equation, Heading, Paragraph, Table, math, number
from railride.numeric import MatrixFunction, symmetric_eigenvalues
from railride.report.document import Subject, definitions


def parameters(subject: Subject) -> list[Block]:
    """Symbols, values, units and meanings; what is defined by others."""
    known, defined = subject.model.meanings, subject.model.body.definitions
    rows = [
        (f"${math(sp.Symbol(name))}$", number(float(value)), *_words(known.get(name, ("", ""))))
        for name, value in subject.values.items()
    ]
    between = (
        [Paragraph("Among them, defined by the others:"), *definitions(defined)] if defined else []
    )
    return [
        Heading("Parameters"),
        Table(("symbol", "value", "unit", "meaning"), rows, figures=("value",)),
        *between,
    ]


def _words(meaning_unit: tuple[str, str]) -> tuple[str, str]:
    meaning, unit = meaning_unit
    return unit.replace("^2", "²"), meaning


def modes(subject: Subject) -> list[Block]:
    """Natural frequencies, damping ratios and what moves."""
    return _free_modes(subject) if subject.alone else _vehicle_modes(subject)


def _vehicle_modes(subject: Subject) -> list[Block]:
    model = subject.model
    rows = [
        (
            mode.label,
            f"{mode.frequency_hz:.4f}",
            number(mode.damping_ratio, 4),
            f"{100 * mode.share:.0f} %",
        )
        for mode in modal.modes(model)
    ]
    undamped = ", ".join(f"{f:.4f}" for f in modal.undamped_frequencies(model.matrices()))
    columns = ("mode", "frequency [Hz]", "damping ratio", "energy share")
    return [
        Heading("Natural frequencies and modes"),
        Paragraph(r"From $(\lambda^2 M + \lambda C + K) \varphi = 0$: the frequency is "
                  r"$\vert\lambda\vert / 2\pi$, the damping ratio "
                  r"$-\mathrm{Re} \lambda / \vert\lambda\vert$; a mode is named after the free "
                  "motion that holds the given share of its kinetic energy."),
        Table(columns, rows, figures=columns[1:]),
        Paragraph(f"Undamped, from $K$ and $M$ alone: {undamped} Hz."),
    ]  # fmt: skip


def _free_modes(subject: Subject) -> list[Block]:
    """Those of the body alone, beside a uniform beam's of the same first frequency."""
    numbers = MatrixFunction({name: subject.linear.matrices[name] for name in "MK"})(
        {name: np.asarray(value) for name, value in subject.values.items()}
    )
    squares = symmetric_eigenvalues(numbers["M"], numbers["K"])[2:]
    found = np.sqrt(squares) / (2 * np.pi)
    if not found.size:
        return [
            Heading("Natural frequencies and modes"),
            Paragraph("Both motions, heave and pitch, are free: their frequency is 0."),
        ]
    beam = (slender_beam.roots(found.size) / slender_beam.roots(1)) ** 2
    rows = [
        (f"bending {i}", f"{f:.4f}", f"{f / found[0]:.4f}", f"{ratio:.4f}")
        for i, (f, ratio) in enumerate(zip(found, beam, strict=True), start=1)
    ]
    columns = ("mode", "frequency [Hz]", "of the first", "of the first, beam")
    return [
        Heading("Natural frequencies and modes"),
        Paragraph(r"From $(K - \omega^2 M) \varphi = 0$: heave and pitch of the straight body at "
                  "0, and bending. The last column is that of Euler and Bernoulli's uniform free "
                  "beam, to which the segments converge as they become many."),
        Table(columns, rows, figures=columns[1:]),
        *_one_joint(subject),
    ]  # fmt: skip


def _one_joint(subject: Subject) -> list[Block]:
    r"""ω² in symbols where one joint is all that bends: K = k g gᵀ, ω² = k gᵀ M⁻¹ g."""
    K, M = subject.linear.K, subject.linear.M
    if subject.model.body.segments != 2:
        return []
    squares = sp.factor(sp.trace(M.LUsolve(sp.Matrix(K))))
    return [Paragraph("One joint bends, and its frequency is known in symbols,"),
            Equation(rf"\omega^2 = {math(squares)}"),
            Paragraph("for two halves of $m_h = m_c / 2$ and $L_h = L / 2$ the "
                      r"$24 k_\theta / (m_h L_h^2)$ of the paper's free body.")]  # fmt: skip
