"""Sea states: spectra, dispersion, directional spreading, wave components and their elevation."""
