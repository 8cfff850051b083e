"""The recording in the output folder of a run."""

from pathlib import Path

RECORDING = "recording.csv"
METRICS = "norms.json"


def recording_file(path: str | Path) -> Path:
    """Return the file of a recording that is given as a file, or as the output folder of a run.

    Args:
        path: A file, or a folder with a recording.csv.
    """
    path = Path(path)
    inside = path / RECORDING
    return inside if inside.is_file() else path


def is_in_run_folder(path: Path) -> bool:
    """Return whether a file lies in the output folder of a run.

    Args:
        path: The file.
    """
    return (path.parent / METRICS).is_file()
