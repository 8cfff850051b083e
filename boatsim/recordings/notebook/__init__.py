"""Recordings in notebooks: as Arrow tables and data frames, as figures and as replays."""
