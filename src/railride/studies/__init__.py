"""Study files: a vehicle, its rides and the parameters that are varied, from one TOML file.

ranges (what a parameter takes) → parameters (which ones, with their units) → body, cases (how the
body is made, what is ridden) → study (the whole of it) → read (from a file).
"""

from railride.studies.body import BodyOptions
from railride.studies.cases import RideCases
from railride.studies.parameters import StudyParameter
from railride.studies.ranges import Listed, Range
from railride.studies.read import Draft, read_study, shipped_studies
from railride.studies.study import Study

__all__ = [
    "BodyOptions",
    "Draft",
    "Listed",
    "Range",
    "RideCases",
    "Study",
    "StudyParameter",
    "read_study",
    "shipped_studies",
]
