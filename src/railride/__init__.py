"""railride: vertical dynamics and ride comfort of railway vehicles, from symbols to numbers.

    >>> import railride as rr
    >>> model = rr.derive_vehicle(rr.load_vehicle("cati2024"), segments=2)
    >>> round(float(model.bending_frequencies()[0]), 6)
    9.6

Everything below is loaded when it is first used: ``import railride`` itself costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

KMH = 1 / 3.6
"""One kilometre per hour in m/s: ``speed=145 * KMH``."""

_WHERE = {
    "parameters": ("CarBody", "BodyProfile", "PointMass", "Segment", "Elements", "ModeFiles",
                   "Bogie", "Load", "Equipment", "Vehicle", "load_vehicle", "write_vehicle",
                   "shipped_vehicles"),
    "lagrange": ("Coordinate", "Input", "Force", "Lagrangian", "rate"),
    "linear": ("LinearModel", "linearise", "linearise_equations"),
    "halfbody": ("half_body",),
    "vehicle": ("VehicleModel", "Output", "derive_vehicle"),
    "modal": ("Mode", "modes"),
    "loci": ("mode_locus",),
    "statespace": ("state_space",),
    "frequency": ("frequency_response", "track_response"),
    "bodes": ("bode",),
    "spectra": ("Spectrum", "fit_spectra", "read_spectrum", "spectrum", "spectrum_from_table",
                "spectrum_names"),
    "track": ("Track", "synthesise"),
    "trackfile": ("read_track", "write_track"),
    "response": ("simulate",),
    "nonlinear": ("simulate_nonlinear",),
    "stochastic": ("stochastic_ride", "comfort_map", "measured_spectrum", "mode_shares",
                   "output_statistics", "spectrum_fits", "third_octaves"),
    "weightings": ("Weighting", "weighting", "weighting_names", "apply_weighting"),
    "comfort": ("AccelerationRecord", "Axis", "RecordRating", "indices", "rate_record"),
    "records": ("read_record",),
    "rides": ("RideResult", "ride"),
    "active": ("Loop", "loop_spectra", "lqg", "rate_loops", "semi_active_ride", "skyhook",
               "suspension_signals"),
    "comparison": ("Comparison", "compare_bodies"),
    "designs": ("DesignValues", "evaluate_designs"),
    "distributions": ("Distribution", "sample"),
    "changed_vehicle": ("vehicle_with",),
    "sweeps": ("SweepResult", "read_sweep", "sweep"),
    "optimisation": ("Optimum", "ParetoFront", "optimise", "pareto_front"),
    "studies": ("Study", "read_study", "shipped_studies"),
    "uncertainties": ("Uncertainty", "study_uncertainty", "uncertainty"),
    "sensitivities": ("Derivatives", "Sensitivities", "mean_squares_with_gradient",
                      "roots_with_gradient", "sensitivity",
                      "static_deflections_with_gradient"),
    "exports.write": ("export_model",),
    "plots": ("plot_bending_convergence", "plot_comparison", "plot_convergence",
              "animate_mode", "plot_acceleration", "plot_bode", "plot_body_coordinates",
              "plot_coordinates", "plot_half_body", "plot_comfort",
              "plot_comfort_along", "plot_comfort_map", "plot_comfort_over_speed", "plot_damping",
              "plot_loci", "plot_loop_spectra", "plot_loops", "plot_modes", "plot_optimum",
              "plot_optimum_comfort", "plot_optimum_limits", "plot_optimum_parameters",
              "plot_pareto", "plot_record",
              "plot_record_rating", "plot_record_spectrum", "plot_ride", "plot_running_rms",
              "plot_root_locus", "plot_sobol_indices", "plot_sweep", "plot_tornado",
              "plot_tornadoes", "plot_track", "plot_track_overview", "plot_track_spectrum",
              "plot_uncertainty", "plot_uncertainty_study"),
    "errors": ("InputError",),
}  # fmt: skip
_MODULE_OF = {name: module for module, names in _WHERE.items() for name in names}

__all__ = ["KMH", "__version__", *sorted(_MODULE_OF)]  # noqa: PLE0604


def __getattr__(name: str) -> Any:
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    return __all__
