% Loads and motions of MSS for given waves, called by validation/waves/peers/mss.py.
% MSS draws the phases of its waves by rand; rand.m next to the input returns the given ones.
global SEA_PHASES
load(input_file);
SEA_PHASES = phase(:);
addpath(environment);
addpath(fileparts(input_file));
found = load(table_file);
vessel = found.vessel;
if thinned
  vessel.headings = vessel.headings(1:2:end);
  for part = {'forceRAO', 'motionRAO'}
    for axis = 1:6
      vessel.(part{1}).amp{axis} = vessel.(part{1}).amp{axis}(:, 1:2:end, :);
      vessel.(part{1}).phase{axis} = vessel.(part{1}).phase{axis}(:, 1:2:end, :);
    end
  end
end
N = numel(omega);
loads = zeros(numel(psi), numel(t), 6);
motions = loads;
elevation = zeros(1, numel(t));
begin = tic;
for h = 1:numel(psi)
  for k = 1:numel(t)
    [own, elevation(k)] = waveForceRAO(t(k), ones(N, 1), amplitude(:), omega(:), 0, vessel, 0, ...
      psi(h), toward, N);
    loads(h, k, :) = own;
  end
end
seconds = toc(begin);
if with_motions
  for h = 1:numel(psi)
    for k = 1:numel(t)
      [own, ~, ~, ~] = waveMotionRAO(t(k), ones(N, 1), amplitude(:), omega(:), 0, vessel, 0, ...
        psi(h), toward, N);
      motions(h, k, :) = own;
    end
  end
end
pierson = waveSpectrum(5, [height, 0.710 * period], spectrum_omega(:), 0);
jonswap = waveSpectrum(7, [height, 2 * pi / period, gamma_peak], spectrum_omega(:), 0);
torsethaugen = waveSpectrum(8, [height, 2 * pi / period], spectrum_omega(:), 0);
save('-v7', output_file, 'loads', 'motions', 'elevation', 'seconds', 'pierson', 'jonswap', ...
  'torsethaugen');
