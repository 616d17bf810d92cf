"""Names in another tool's form, and back."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railride.errors import InputError
from railride.exports.names import Names

NAMES = Names(frozenset({"lambda", "time", "x_1", "a_"}))
ANY = st.text(min_size=1, max_size=12) | st.text("_ux5fd2-é", min_size=1, max_size=12)


@given(ANY)
def test_a_name_comes_back_as_it_was(name):
    assert NAMES.original(NAMES.written(name)) == name


@given(ANY)
def test_what_is_written_is_a_name_everywhere_and_not_reserved(name):
    written = NAMES.written(name)
    assert re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", written)
    assert written not in NAMES.reserved


@given(ANY, ANY)
def test_two_names_are_never_written_alike(one, other):
    assert (NAMES.written(one) == NAMES.written(other)) == (one == other)


@pytest.mark.parametrize(("name", "written"), [
    ("k_theta", "k_theta"), ("theta_b1", "theta_b1"), ("lambda", "lambda_"), ("time", "time_"),
    ("Coach 2", "Coach_u20_2"), ("2nd", "x_2nd"), ("k_", "k__"),
    ("x_2", "x_x_2"), ("θ", "x__u3b8__"),
])  # fmt: skip
def test_the_stated_rules(name, written):
    assert NAMES.written(name) == written


def test_too_long_for_the_target():
    with pytest.raises(InputError, match=r"found 64 characters .* expected at most 63"):
        Names(frozenset(), longest=63).written("a" * 64)
    with pytest.raises(InputError, match="empty"):
        NAMES.written("")
