r"""Natural modes of a free car body, known in points along it: a record that checks itself.

Modes come in any scale, each with its modal mass :math:`m_i = \int\varphi_i^2\,dm`. Two rigid
motions :math:`a_j + b_j x` among them give the body's mass, mass centre and pitch inertia:

.. math:: G = R^{-T}\,\mathrm{diag}(m_1, m_2)\,R^{-1}, \qquad
          R = \begin{pmatrix} a_1 & a_2 \\ b_1 & b_2 \end{pmatrix}, \quad
          G = \begin{pmatrix} m_c & m_c e_c \\ m_c e_c & I_c + m_c e_c^2 \end{pmatrix} .

Source: D. J. Ewins, Modal Testing, Research Studies Press 2000, Section 2.3 (modal mass).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from railride.errors import Faults
from railride.numeric import Array
from railride.toml_tables import expected_sign

RIGID = 0.1  # Hz: below it a natural frequency is zero but for rounding
POINTS = 8  # at least
STRAIGHT = 0.01  # of a rigid motion's largest height: so near a straight line it is rigid


@dataclass(frozen=True, eq=False)
class PointModes:
    """Natural modes of a free car body in points along it.

    Parameters
    ----------
    source : where they come from, for messages.
    x : (p,) the points, m forward of the body's middle, ascending.
    frequencies : (n,) Hz, of rigid motions below 0.1. modal_masses : (n,) kg.
    shapes : (n, p) heights, upward, in the scale of the modal masses.
    damping : (n,) damping ratios, where they are given.
    point_masses : (p,) kg, where they are given: the body's whole mass, shared among the points.
    remarks : what a user must know of them.

    Raises
    ------
    InputError : with all faults at once: numbers that cannot be; too few points; one rigid motion
        alone, or more than two, or one that is not straight; no flexible mode.

    Examples
    --------
    >>> x = np.linspace(-10, 10, 9)
    >>> bow = 1 - 3 * (x / 10) ** 2
    >>> modes = PointModes("bow", x, [0, 0, 9], [3e4, 1e6, 2.4e4], [1 + 0 * x, x, bow])
    >>> modes.rigid_body()
    (30000.0, 0.0, 1000000.0)
    """

    source: str
    x: Array
    frequencies: Array
    modal_masses: Array
    shapes: Array
    damping: Array | None = None
    point_masses: Array | None = None
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        faults = Faults(self.source)
        for item in fields(self):
            value = getattr(self, item.name)
            if item.name not in {"source", "remarks"} and value is not None:
                object.__setattr__(self, item.name, np.asarray(value, dtype=float))
        self._check_points(faults)
        self._check_values(faults)
        faults.raise_if_any()
        self._check_rigid(faults)
        faults.raise_if_any()

    @property
    def rigid(self) -> NDArray[np.bool_]:
        """Which of the modes are rigid motions, (n,)."""
        return self.frequencies < RIGID

    @property
    def flexible(self) -> NDArray[np.intp]:
        """Numbers of the others, by their natural frequencies."""
        numbers = np.flatnonzero(~self.rigid)
        return numbers[np.argsort(self.frequencies[numbers], kind="stable")]

    def rigid_body(self) -> tuple[float, float, float] | None:
        """Mass (kg), mass centre (m) and pitch inertia (kg m²) by the rigid motions, if given."""
        if not self.rigid.any():
            return None
        inverse = np.linalg.inv(self._lines())
        G = inverse.T @ np.diag(self.modal_masses[self.rigid]) @ inverse
        centre = G[0, 1] / G[0, 0]
        return float(G[0, 0]), float(centre), float(G[1, 1] - G[0, 0] * centre**2)

    def _lines(self) -> Array:
        """(2, rigid motions): the straight lines a + bx nearest to them."""
        straight = np.column_stack([np.ones_like(self.x), self.x])
        return np.asarray(np.linalg.lstsq(straight, self.shapes[self.rigid].T, rcond=None)[0])

    def _check_points(self, faults: Faults) -> None:
        if len(self.x) < POINTS:
            faults.add("points", len(self.x), f"at least {POINTS} along the body")
        for i in np.flatnonzero(~(np.diff(self.x) > 0)):
            faults.add(f"point {i + 2}", f"x = {self.x[i + 1]:g} m after {self.x[i]:g} m",
                       "points from the rear to the front, each once")  # fmt: skip
        n, p = len(self.frequencies), len(self.x)
        for name, shape in (("shapes", (n, p)), ("modal_masses", (n,)), ("damping", (n,)),
                            ("point_masses", (p,))):  # fmt: skip
            value = getattr(self, name)
            if value is not None and value.shape != shape:
                faults.add(name, f"an array of shape {value.shape}", f"{shape}")
            elif value is not None and not np.isfinite(value).all():
                faults.add(name, "a value that is no finite number", "finite numbers")

    def _check_values(self, faults: Faults) -> None:
        for what, quantity, unit, sign in (
            ("mode", "frequencies", "Hz", ">= 0"),
            ("mode", "modal_masses", "kg", "> 0"),
            ("mode", "damping", "", ">= 0"),
            ("point", "point_masses", "kg", ">= 0"),
        ):
            values = getattr(self, quantity)
            for i, value in enumerate([] if values is None else values.tolist(), start=1):
                expected = expected_sign(value, sign)
                if expected:
                    found = f"{value:g} {unit}".rstrip()
                    faults.add(f"{what} {i}, {quantity}", found, expected)

        if self.point_masses is not None and not self.point_masses.any():
            faults.add("point_masses", "zeros only", "the body's mass, shared among the points")

    def _check_rigid(self, faults: Faults) -> None:
        numbers = np.flatnonzero(self.rigid)
        if self.rigid.all():
            faults.add("modes", f"none above {RIGID:g} Hz", "at least one flexible mode")
        if not numbers.size:
            return
        lines = self._lines()
        straight = np.column_stack([np.ones_like(self.x), self.x]) @ lines
        shapes = self.shapes[numbers].T
        off = np.abs(shapes - straight).max(axis=0) / np.abs(shapes).max(axis=0)
        for i, share in zip(numbers, off, strict=True):
            if not share <= STRAIGHT:
                faults.add(f"mode {i + 1}", f"{self.frequencies[i]:.3g} Hz, and a shape that "
                           f"departs from a straight line by {share:.1%} of its height",
                           "a rigid motion, straight, at 0 Hz")  # fmt: skip
        if numbers.size != 2 or abs(np.linalg.det(lines / np.linalg.norm(lines, axis=0))) < 1e-6:
            faults.add("rigid motions", f"{numbers.size} below {RIGID:g} Hz, mode"
                       f"{'s' * (numbers.size != 1)} {', '.join(str(i + 1) for i in numbers)}",
                       "two different ones, heave and pitch, or none", "a free body has both; "
                       "without them they are made from the body's mass and inertia")  # fmt: skip
