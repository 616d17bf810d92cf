"""Pictures of what was computed elsewhere: tracks, rides, mode shapes, to the screen or a file.

``plot_…(data, *, ax=None)`` draws into the axes given, or into a figure of its own, and returns the
axes; what needs several axes returns the figure. Nothing is shown and no setting is touched: the
figures know nothing of pyplot, and matplotlib is loaded when the first one is drawn.
"""

from railride.plots.active import plot_loop_spectra, plot_loops
from railride.plots.animation import animate_mode
from railride.plots.bode import plot_bode
from railride.plots.canvas import save
from railride.plots.comparison import (
    plot_bending_convergence,
    plot_comparison,
    plot_convergence,
)
from railride.plots.coordinates import (
    plot_body_coordinates,
    plot_coordinates,
    plot_half_body,
)
from railride.plots.loci import plot_damping, plot_loci, plot_root_locus
from railride.plots.modes import MOST_MODES, chosen_modes, left_out, plot_modes
from railride.plots.optimisation import (
    plot_optimum,
    plot_optimum_comfort,
    plot_optimum_limits,
    plot_optimum_parameters,
    plot_pareto,
)
from railride.plots.records import (
    plot_record,
    plot_record_rating,
    plot_record_spectrum,
    plot_running_rms,
)
from railride.plots.rides import plot_acceleration, plot_ride, save_ride_plots
from railride.plots.stochastic import (
    plot_comfort,
    plot_comfort_along,
    plot_comfort_map,
    plot_comfort_over_speed,
)
from railride.plots.sweeps import plot_sweep
from railride.plots.tornado import plot_tornado, plot_tornadoes
from railride.plots.tracks import plot_track, plot_track_overview, plot_track_spectrum
from railride.plots.uncertainty import (
    plot_sobol_indices,
    plot_uncertainty,
    plot_uncertainty_study,
)

__all__ = [
    "MOST_MODES",
    "animate_mode",
    "chosen_modes",
    "left_out",
    "plot_acceleration",
    "plot_bending_convergence",
    "plot_bode",
    "plot_body_coordinates",
    "plot_comfort",
    "plot_comfort_along",
    "plot_comfort_map",
    "plot_comfort_over_speed",
    "plot_comparison",
    "plot_convergence",
    "plot_coordinates",
    "plot_damping",
    "plot_half_body",
    "plot_loci",
    "plot_loop_spectra",
    "plot_loops",
    "plot_modes",
    "plot_optimum",
    "plot_optimum_comfort",
    "plot_optimum_limits",
    "plot_optimum_parameters",
    "plot_pareto",
    "plot_record",
    "plot_record_rating",
    "plot_record_spectrum",
    "plot_ride",
    "plot_root_locus",
    "plot_running_rms",
    "plot_sobol_indices",
    "plot_sweep",
    "plot_tornado",
    "plot_tornadoes",
    "plot_track",
    "plot_track_overview",
    "plot_track_spectrum",
    "plot_uncertainty",
    "plot_uncertainty_study",
    "save",
    "save_ride_plots",
]
