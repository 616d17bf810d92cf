"""All comparisons, in the order of the results."""

from __future__ import annotations

import derivation
import frequency
import records
import rides
import studies
import sweeps
from measure import Case

CASES: dict[str, Case] = {
    **rides.CASES,
    **derivation.CASES,
    **frequency.CASES,
    **records.CASES,
    **studies.CASES,
    **sweeps.CASES,
}
"""Name to the case and the number of its steps."""
