"""Large batches on NVIDIA Warp, on a GPU or on its CPU device."""

from boatsim.warp.batch import Batch as Batch
