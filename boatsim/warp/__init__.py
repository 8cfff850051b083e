"""Large batches on Warp: a vessel's compiled program, translated, on a GPU or on Warp's CPU device."""

from boatsim.warp.batch import Batch as Batch
