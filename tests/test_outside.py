"""Car bodies from outside: natural modes in tables and matrices in files, and what is refused."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from outside_bodies import ELEMENTS_HZ, INERTIA, MASS, MU, L, beam, hull
from scipy.io import mmwrite
from scipy.sparse import coo_array

from railride.bodies.element_modes import element_modes
from railride.bodies.matrices import BodyMatrices
from railride.bodies.matrix_files import read_matrix_market, read_npz
from railride.bodies.modes_file import read_modes
from railride.bodies.outside import outside_modes
from railride.bodies.point_modes import PointModes
from railride.body_profile import BodyProfile, PointMass
from railride.car_body import CarBody
from railride.errors import InputError

BODY = CarBody(MASS, INERTIA, L, bending_damping=0.01)
PROFILE = BodyProfile((-12, 3, 3, 12), (3e9, 2e9, 1e9, 3e9), (1400, 1400, 2000, 1000),
                      point_masses=(PointMass(2000, -6), PointMass(1500, 5)))  # fmt: skip
UNEVEN = CarBody.of(PROFILE)
X = np.linspace(-L / 2, L / 2, 49)


def points(body=BODY, count=4, x=X, **changes):
    """What a department would hand over of a beam, in an odd scale, front first or not."""
    profile = PROFILE if body is UNEVEN else BodyProfile((-12, 12), (3e9, 3e9), (MU, MU))
    modes = element_modes(profile, count)
    scale = np.array([3.0, -0.2, 1e-3, 40.0, 1.0, 7.0])[:count]
    given = {
        "source": "modes",
        "x": x,
        "frequencies": modes.frequencies,
        "modal_masses": scale**2 * body.mass,
        "shapes": scale[:, np.newaxis] * modes.shapes(x),
    }
    return PointModes(**given | changes), modes


def lumps(profile, x=X):
    """Masses of the stretches nearest to each point."""
    ends = np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])
    return np.array([profile.moments(a, b)[0] for a, b in pairwise(ends)])


def with_rigid(modes, body, a=((2.0, 1.0), (0.3, -0.5))):
    """The modes with two rigid motions a_j + b_j x in front, orthogonal in the body's mass."""
    m, e = body.mass, body.mass_centre
    G = np.array([[m, m * e], [m * e, body.pitch_inertia + m * e**2]])
    first = np.array(a[0])
    second = np.array(a[1]) - first * (first @ G @ a[1]) / (first @ G @ first)
    R = np.array([first, second])
    return replace(
        modes,
        frequencies=np.concatenate([[1e-4, 3e-3], modes.frequencies]),
        modal_masses=np.concatenate([np.diag(R @ G @ R.T), modes.modal_masses]),
        shapes=np.vstack([R @ [np.ones_like(modes.x), modes.x], modes.shapes]),
    )


@pytest.mark.parametrize(
    ("body", "atol"), [(BODY, 3e-4), (UNEVEN, 4e-3)], ids=["even", "with jumps of EI"]
)
def test_modes_in_points_are_the_beams(body, atol):
    given, exact = points(body)
    found = outside_modes(given, body, attachments=(-8.75, 8.75))
    x = np.linspace(-L / 2, L / 2, 301)
    sign = np.sign(found.shapes(L / 2) * exact.shapes(L / 2))[:, np.newaxis]
    np.testing.assert_array_equal(found.frequencies, exact.frequencies)
    np.testing.assert_allclose(found.shapes(x) * sign, exact.shapes(x), atol=atol)
    np.testing.assert_allclose(found.slopes(x) * sign, exact.slopes(x), atol=15 * atol)
    assert found.damping is None
    assert found.kind == "modes"
    assert found.remarks == ()


def test_rigid_motions_give_mass_centre_and_inertia():
    given = with_rigid(points(UNEVEN)[0], UNEVEN)
    np.testing.assert_allclose(
        given.rigid_body(), (UNEVEN.mass, UNEVEN.mass_centre, UNEVEN.pitch_inertia), rtol=1e-9
    )
    found = outside_modes(given, UNEVEN)
    np.testing.assert_array_equal(found.frequencies, points(UNEVEN)[0].frequencies)


def test_modes_out_of_order_are_put_in_order():
    given, exact = points()
    order = [2, 0, 3, 1]
    mixed = replace(
        given,
        frequencies=given.frequencies[order],
        shapes=given.shapes[order],
        modal_masses=given.modal_masses[order],
        damping=[0.3, 0.1, 0.4, 0.2],
    )
    found = outside_modes(mixed, BODY, count=3)
    np.testing.assert_array_equal(found.frequencies, exact.frequencies[:3])
    np.testing.assert_array_equal(found.damping, [0.1, 0.2, 0.3])


def test_ends_beyond_the_points_are_straight():
    given, exact = points(x=np.linspace(-11.5, 11.5, 47))
    found = outside_modes(given, BODY, count=3)
    end = np.abs(found.shapes([-L / 2, L / 2]))
    np.testing.assert_allclose(end, np.abs(exact.shapes([-L / 2, L / 2])[:3]), rtol=0.01)


def test_points_that_end_far_from_the_ends_are_said():
    given = points(x=np.linspace(-9, 9, 37))[0]
    (remark,) = outside_modes(given, BODY, attachments=(8.75, -8.75), count=3).remarks
    assert "beyond x = -9 and 9 m" in remark


@pytest.mark.parametrize("body", [BODY, UNEVEN], ids=["even", "uneven"])
def test_point_masses_pass_true_modes(body):
    profile = PROFILE if body is UNEVEN else BodyProfile((-12, 12), (3e9, 3e9), (MU, MU))
    given = replace(points(body)[0], point_masses=lumps(profile))
    assert outside_modes(given, body).remarks == ()
    shearing = replace(profile, shear_stiffness=(2e8,) * len(profile.x),
                       rotary_inertia=(3000.0,) * len(profile.x))  # fmt: skip
    modes = element_modes(shearing, 8)
    turning = PointModes("modes", X, modes.frequencies, np.full(8, body.mass), modes.shapes(X),
                         point_masses=lumps(profile))  # fmt: skip
    outside_modes(turning, CarBody.of(shearing))


def mixed(given):
    shapes = given.shapes.copy()
    shapes[1] += 0.3 * shapes[3] * np.sqrt(given.modal_masses[1] / given.modal_masses[3])
    return {"shapes": shapes}


def lifted(given):
    shapes = given.shapes.copy()
    shapes[0] += 0.3 * 3.0
    return {"shapes": shapes}


@pytest.mark.parametrize(
    ("spoilt", "words"),
    [
        (mixed, r"mode 2 and mode 4: found 0\.31 of their own products in common; expected"),
        (lifted, r"a uniform lift and mode 1: found 0\.3 of their own products in common"),
        (lambda g: {"modal_masses": g.modal_masses * [1, 1, 0.5, 1]},
         "mode 3: found heights with 2.01 times its modal mass"),
        (lambda g: {"point_masses": g.point_masses / 1000},
         "point masses: found a mass of 33.6 kg; expected 33600 kg .*is a unit wrong"),
    ],
)  # fmt: skip
def test_modes_that_the_point_masses_contradict_are_refused(spoilt, words):
    given = replace(points()[0], point_masses=lumps(BodyProfile((-12, 12), (1, 1), (MU, MU))))
    with pytest.raises(InputError, match=words):
        outside_modes(replace(given, **spoilt(given)), BODY)


def test_small_contradictions_are_said():
    given = replace(points()[0], point_masses=lumps(BodyProfile((-12, 12), (1, 1), (MU, MU))))
    shapes = given.shapes.copy()
    shapes[0] += 0.05 * 3.0
    (remark,) = outside_modes(replace(given, shapes=shapes), BODY).remarks
    assert "a uniform lift and mode 1 have 0.049 of their own products in common" in remark


@pytest.mark.parametrize(
    ("factor", "words"),
    [(1000.0, r"modal masses: found heights up to 0\.06"), (0.001, "heights up to 6")],
)
def test_modal_masses_in_another_unit_are_refused(factor, words):
    given = points()[0]
    with pytest.raises(InputError, match=words):
        outside_modes(replace(given, modal_masses=given.modal_masses * factor), BODY)


@pytest.mark.parametrize(("factor", "words"), [(0.01, "20"), (1000, "0.0632")])
def test_a_modal_mass_of_another_scale_is_doubted(factor, words):
    given = points()[0]
    scaled = replace(given, modal_masses=given.modal_masses * [1, 1, factor, 1])
    (remark,) = outside_modes(scaled, BODY).remarks
    assert remark.startswith(f"mode 3 reaches {words}, scaled to")


def test_one_modal_mass_in_another_unit_is_refused():
    given = points()[0]
    scaled = replace(given, modal_masses=given.modal_masses * [0.001, 1, 1000, 1])
    with pytest.raises(InputError, match=r"mode 1: found heights up to 63\.2, .* than 30 \(its"):
        outside_modes(scaled, BODY)


def test_modes_of_a_supported_body_are_doubted():
    shape = np.cos(np.pi * X / 17.5)  # pinned at the bogies, and so not free
    given = PointModes("modes", X, [9.0], [MASS / 2], [shape + 0.5])
    (remark,) = outside_modes(given, BODY).remarks
    assert remark.startswith("a uniform lift and mode 1 would have 0.87 of their own products")
    assert "are they natural motions of the free body?" in remark


@pytest.mark.parametrize(
    ("shapes", "words"),
    [
        (lambda s: s + [[0], [0.6], [0], [0]] * s[0], "mode 1 and mode 2 would have 0.51 of"),
        (lambda s: s + [[0], [0.5], [0], [0]] * s[3], "mode 2 and mode 4 would have 0.45 of"),
        (lambda s: s + np.outer([0, 1, 0, 0], 0.5 * X / (L / np.sqrt(12))),
         "pitch about the mass centre and mode 2 would have 0.45 of"),
    ],
    ids=["neighbours", "both uneven", "pitch"],
)  # fmt: skip
def test_modes_in_common_without_point_masses_are_doubted(shapes, words):
    given = points(modal_masses=np.full(4, MASS), shapes=shapes(points()[1].shapes(X)))[0]
    (remark,) = outside_modes(given, BODY).remarks  # a / (1 + a²)^½ of unit motions a apart
    assert remark.startswith(words)
    assert "cannot be checked without point masses" in remark


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"x": X * 1000}, r"48 off the body, such as x = -12000 m.*millimetres"),
        ({"x": X + 12}, r"24 off the body, such as x = 24 m.*not from an end: shift it by 12 m"),
        ({"x": X * 0.7}, r"none beyond x = -8.4 and 8.4 m; expected points on both sides of 8.75"),
    ],
)
def test_points_in_the_wrong_place_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        outside_modes(
            points(**changes)[0] if "x" not in changes else replace(points()[0], **changes),
            BODY,
            attachments=(8.75, -8.75),
        )


def test_too_few_points_for_a_mode_are_refused():
    few = points(count=6, x=np.linspace(-L / 2, L / 2, 9))[0]
    with pytest.raises(InputError, match=r"mode 6: found 7 changes of sign over 9 points.* 14"):
        outside_modes(few, BODY)


def test_the_error_between_the_points_is_no_more_than_said():
    given, exact = points(count=4, x=np.linspace(-L / 2, L / 2, 13))
    found = outside_modes(given, BODY)
    x = np.linspace(-L / 2, L / 2, 301)
    off = np.abs(np.abs(found.shapes(x)[3]) - np.abs(exact.shapes(x)[3])).max() / 2
    (said,) = (r for r in found.remarks if r.startswith("mode 4 errs by about"))
    assert 0.2 < off / (float(said.split("about ")[1].split("%")[0]) / 100) < 1


def test_a_frequency_in_another_unit_is_doubted():
    given = points()[0]
    found = outside_modes(replace(given, frequencies=given.frequencies * 2 * np.pi * 2), BODY)
    assert any("is a unit wrong?" in r for r in found.remarks)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mass": MASS / 1000}, "a mass of 33600 kg; expected 33.6 kg .*is a unit wrong"),
        ({"pitch_inertia": INERTIA * 1.1}, "rigid motions: found a pitch inertia of"),
        ({"mass_centre": 0.5}, "rigid motions: found a mass centre of"),
    ],
)
def test_rigid_motions_of_another_body_are_refused(changes, words):
    given = with_rigid(points()[0], BODY)
    with pytest.raises(InputError, match=words):
        outside_modes(given, replace(BODY, **changes))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"x": X[::-1]}, r"point 2: found x = 11\.5 m after 12 m"),
        ({"x": X[:7], "shapes": np.ones((4, 7))}, "points: found 7; expected at least 8"),
        ({"modal_masses": [1, 0, 1, 1]}, "mode 2, modal_masses: found 0 kg; expected a positive"),
        ({"frequencies": [9, -1, 30, 40]}, "mode 2, frequencies: found -1 Hz"),
        ({"damping": [0, 0, -0.1, 0]}, r"mode 3, damping: found -0\.1; expected a number of at"),
        ({"point_masses": np.zeros(49)}, "point_masses: found zeros only"),
        ({"shapes": np.ones((3, 49))}, r"shapes: found an array of shape \(3, 49\)"),
        ({"shapes": np.full((4, 49), np.nan)}, "no finite number"),
        ({"frequencies": [0.0, 9, 30, 40]}, r"mode 1: found 0 Hz, and a shape that departs"),
        ({"frequencies": [0.0, 9, 30, 40], "shapes": np.ones((4, 49))},
         r"rigid motions: found 1 below 0.1 Hz, mode 1; expected two"),
        ({"frequencies": [0.0, 0.0, 30, 40], "shapes": np.ones((4, 49))},
         r"rigid motions: found 2 below 0.1 Hz, modes 1, 2; expected two different ones"),
        ({"frequencies": [0.0] * 4}, "modes: found none above 0.1 Hz"),
    ],
)  # fmt: skip
def test_records_that_cannot_be_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        points(**changes)


# Tables


def table(given, names=("frequency [Hz]", "modal_mass [t]"), head="x [m]"):
    lines = [",".join([head, *(f"mode {i + 1}" for i in range(len(given.frequencies)))])]
    for name, values in zip(names, (given.frequencies, given.modal_masses / 1000), strict=True):
        lines.append(",".join([name, *map(repr, values.tolist())]))
    for x, row in zip(given.x, given.shapes.T, strict=True):
        lines.append(",".join(map(repr, [float(x), *row.tolist()])))
    return lines


def written(tmp_path, lines):
    path = tmp_path / "coach.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_a_table_gives_the_modes_back(tmp_path):
    given = with_rigid(points()[0], BODY)
    lines = table(given)
    lines.insert(3, "damping_ratio,0,0,0.01,0.02,0.03,0.04")
    lines[4:] = lines[:3:-1]  # from the front
    found = read_modes(written(tmp_path, lines))
    for name in ("x", "frequencies", "shapes"):
        np.testing.assert_array_equal(getattr(found, name), getattr(given, name))
    np.testing.assert_allclose(found.modal_masses, given.modal_masses, rtol=1e-15)
    np.testing.assert_array_equal(found.damping, [0, 0, 0.01, 0.02, 0.03, 0.04])


def test_a_table_in_millimetres_with_point_masses(tmp_path):
    given = replace(points()[0], x=X * 1000)
    masses = lumps(BodyProfile((-12, 12), (1, 1), (MU, MU)))
    lines = table(given, head="x_mm")
    ends = ["point_mass [t]", "", "", *map(repr, (masses / 1000).tolist())]
    found = read_modes(written(tmp_path, [f"{a},{b}" for a, b in zip(lines, ends, strict=True)]))
    np.testing.assert_allclose(found.x, X, atol=1e-12)
    np.testing.assert_allclose(found.point_masses, masses, rtol=1e-12)
    assert outside_modes(found, BODY).remarks == ()


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda t: [t[0].replace("x [m]", "place"), *t[1:]], "header: found 0 columns x"),
        (lambda t: [t[0].replace("x [m]", "x"), *t[1:]], "column 'x': found no unit; expected one"),
        (lambda t: [t[0].replace("x [m]", "x [kg]"), *t[1:]], r"column 'x \[kg\]': found the unit"),
        (lambda t: ["x [m],1,2,3,4", *t[1:]], "such as mode 1, not by numbers"),
        (lambda t: [t[0], *t[2:]], r"no row frequency; expected one named frequency \[Hz\]"),
        (lambda t: [t[0], t[1].replace(" [Hz]", ""), *t[2:]], "row 2, column .*: found no unit"),
        (lambda t: [t[0], t[1].replace("[Hz]", "[rad/s]"), *t[2:]], "row 2.*: found the unit 'rad"),
        (lambda t: [*t[:3], t[1], *t[3:]], r"row 4.*'frequency \[Hz\]' a second time"),
        (lambda t: [*t[:3], "colour,1,2,3,4", *t[3:]], "row 4, .*found 'colour'; expected the"),
        (lambda t: [*t[:9], t[9].rpartition(",")[0] + ",abc", *t[10:]],
         "row 10, column 'mode 4': found 'abc'"),
        (lambda t: [line.split(",")[0] for line in t], "header: found 0 columns x"),
    ],
)  # fmt: skip
def test_tables_that_cannot_be_are_refused(tmp_path, spoil, words):
    with pytest.raises(InputError, match=words):
        read_modes(written(tmp_path, spoil(table(points()[0]))))


# Matrices


def test_matrices_of_the_beam_give_its_modes():
    given = BodyMatrices("beam", *beam()).point_modes(4)
    found = outside_modes(given, BODY)
    np.testing.assert_allclose(found.frequencies, ELEMENTS_HZ[:4], rtol=1e-7)
    np.testing.assert_allclose(given.rigid_body(), (MASS, 0.0, INERTIA), rtol=1e-6, atol=1e-6)
    exact = points()[1]
    np.testing.assert_allclose(np.abs(found.shapes(X)), np.abs(exact.shapes(X)), atol=1e-4)


def test_what_does_not_bend_the_centre_line_drops_out():
    given = BodyMatrices("hull", *hull()).point_modes(4)
    found = outside_modes(given, BODY)
    np.testing.assert_allclose(found.frequencies, ELEMENTS_HZ[:4], rtol=1e-7)
    np.testing.assert_allclose(given.rigid_body(), (MASS, 0.0, INERTIA), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(np.abs(found.shapes(X)), np.abs(points()[1].shapes(X)), atol=1e-4)
    assert "do not bend the body's centre line are left out" in found.remarks[0]


def test_large_sparse_matrices_give_the_same(monkeypatch):
    monkeypatch.setattr("railride.bodies.reduction.DENSE", 10)
    found = outside_modes(BodyMatrices("hull", *hull()).point_modes(4), BODY)
    np.testing.assert_allclose(found.frequencies, ELEMENTS_HZ[:4], rtol=1e-7)


def test_massless_coordinates_are_taken():
    """A rod's ends on springs without mass of their own."""
    M, K, x, vertical = beam()
    M, K = np.pad(M, (0, 1)), np.pad(K, (0, 1))
    K[-1, -1] = 1e6
    found = BodyMatrices("beam", M, K, np.append(x, 3.0), np.append(vertical, 0)).point_modes(3)
    np.testing.assert_allclose(found.frequencies[2:], ELEMENTS_HZ[:3], rtol=1e-7)


def test_few_modes_of_small_matrices():
    M, K, x, vertical = beam()
    assert len(BodyMatrices("beam", M, K, x, vertical).point_modes(500).flexible) == len(x) - 2


def spoilt(**changes):
    given = dict(zip(("M", "K", "x", "vertical"), beam(), strict=True))
    return {name: changes.get(name, lambda v: v)(value) for name, value in given.items()}


def put(value, *place):
    def change(A):
        A = A.copy()
        A[place] = value
        return A

    return change


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"M": lambda M: M[:, :-1]}, r"M: found an array of shape \(98, 97\); expected a square"),
        ({"K": lambda K: K[:-1, :-1]}, r"K: found shape \(97, 97\); expected \(98, 98\)"),
        ({"x": lambda x: x[:-1]}, r"x: found shape \(97,\); expected \(98,\)"),
        ({"K": put(np.nan, 3, 3)}, "K: found an entry that is no finite number"),
        ({"vertical": put(2, 4)}, "vertical: found 2; expected 1"),
        ({"K": np.triu}, r"K: found 0 in row 3, column 1, but .* in row 1, column 3;.*triangle"),
        ({"M": lambda M: -M}, "M: found 98 negative eigenvalues"),
        ({"K": lambda K: -K}, "K: found 96 negative eigenvalues"),
        ({"K": lambda K: K - 1e9 * np.eye(len(K))}, r"K: found \d+ negative eigenvalue"),
        ({"M": lambda M: M * 0}, "M: found zeros only"),
        ({"M": put(0, 7, slice(None)), "K": put(0, 7, slice(None))}, "not symmetric|symmetric"),
        ({"K": lambda K: K + np.diag(np.tile([1e6, 0], 49))},
         r"rigid motions: found 0 along the centre line, the lowest .* being 6\.\d+, "),
        ({"K": lambda K: put(K[0, 0] + 1e8, 0, 0)(K)}, "rigid motions: found 1 along the centre"),
        ({"vertical": lambda v: np.roll(v, 1)}, "rigid motions"),
        ({"vertical": lambda v: v * 0}, "vertical: found zeros only"),
    ],
)  # fmt: skip
def test_matrices_that_cannot_be_are_refused(changes, words):
    with pytest.raises(InputError, match=words):
        BodyMatrices("beam", **spoilt(**changes)).point_modes(4)


@pytest.mark.parametrize("name", ["M", "K"])
@pytest.mark.parametrize("share", [-1.0, -1e-3, 0.2])
def test_the_least_eigenvalue_of_an_indefinite_matrix_is_said(name, share):
    given = spoilt()
    A = given[name] = put(share * given[name][20, 20], 20, 20)(given[name])
    with pytest.raises(InputError, match=rf"{name}: found 1 negative eigenvalue, the least") as e:
        BodyMatrices("beam", **given)
    scale = 1 / np.sqrt(np.abs(np.diag(A)))
    exact = np.linalg.eigvalsh(A * np.outer(scale, scale))[0]
    said = float(str(e.value).split("the least ")[1].split(" ")[0])
    np.testing.assert_allclose(said, exact, rtol=6e-3)  # of three digits


def test_a_coordinate_without_mass_and_stiffness_is_named():
    M, K, x, vertical = beam()
    with pytest.raises(InputError, match="row 99: found neither mass nor stiffness"):
        BodyMatrices("beam", np.pad(M, (0, 1)), np.pad(K, (0, 1)), np.append(x, 0),
                     np.append(vertical, 0))  # fmt: skip


# Files of matrices


def test_an_archive_of_matrices_in_other_units(tmp_path):
    M, K, x, vertical = beam()
    path = tmp_path / "coach.npz"
    np.savez(path, M=M / 1000, K=K / 1000, x=x * 1000, vertical=vertical.astype(int))
    found = read_npz(path, mass_unit="t", length_unit="mm").point_modes(4)
    np.testing.assert_allclose(outside_modes(found, BODY).frequencies, ELEMENTS_HZ[:4], rtol=1e-7)
    with pytest.raises(InputError, match=r"a mass of 33\.6 kg; expected 33600 kg"):
        outside_modes(read_npz(path, length_unit="mm").point_modes(4), BODY)


def test_a_pair_of_matrix_market_files(tmp_path):
    M, K, x, vertical = hull()
    for name, A in (("M", M), ("K", K)):
        mmwrite(tmp_path / f"{name}.mtx", coo_array(A), symmetry="symmetric", precision=17)
    rows = [f"{a!r};{int(b)}" for a, b in zip((x * 1000).tolist(), vertical, strict=True)]
    (tmp_path / "dofs.csv").write_text("\n".join(["x [mm];vertical", *rows]), encoding="utf-8")
    paths = (tmp_path / name for name in ("M.mtx", "K.mtx", "dofs.csv"))
    found = outside_modes(read_matrix_market(*paths).point_modes(4), BODY)
    np.testing.assert_allclose(found.frequencies, ELEMENTS_HZ[:4], rtol=1e-7)


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"M": np.eye(2)}, "arrays: found no K, x, vertical among M"),
        ({"M": np.eye(2), "K": np.array([["a", "b"]]), "x": [0, 1], "vertical": [1, 1]},
         "K: found values of type <U1; expected numbers"),
        ({"M": np.array([None]), "K": 1, "x": 1, "vertical": 1}, "none that can be read"),
    ],
)  # fmt: skip
def test_archives_that_cannot_be_are_refused(tmp_path, arrays, words):
    np.savez(tmp_path / "coach.npz", **arrays)
    with pytest.raises(InputError, match=words):
        read_npz(tmp_path / "coach.npz")


def test_other_files_are_refused(tmp_path):
    other = tmp_path / "other.txt"
    other.write_text("nothing of the kind\n", encoding="utf-8")
    for read, words in (
        (lambda: read_npz(other), "an .npz file"),
        (lambda: read_npz(tmp_path / "no.npz"), "no such file"),
        (lambda: read_npz(tmp_path), "none that can be read"),
        (lambda: read_matrix_market(other, other, other), "a matrix in the Matrix Market format"),
        (lambda: read_matrix_market(tmp_path / "no.mtx", other, other), "no such file"),
        (lambda: read_modes(other), "other.txt"),
    ):
        with pytest.raises(InputError, match=words):
            read()
