"""Track files: a measured longitudinal level over distance, every fault named, and written.

headings, cells (what they say) → columns (which are read) → locations (metres from what stands in
the file) → spacing, steps (an even grid) → levels (dropouts, spikes, doubtful units), limits
(the band) → read, and write.
"""

from railride.trackfile.read import load_track, read_track
from railride.trackfile.write import track_text, write_track

__all__ = ["load_track", "read_track", "track_text", "write_track"]
