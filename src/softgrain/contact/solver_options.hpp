#pragma once

namespace softgrain {

/// When a contact algorithm stops. Every measure is unit-free.
struct SolverOptions {
  int min_sweeps = 1;
  int max_sweeps = 1000;
  double tolerance = 1e-4;    ///< on the mean velocity violation, in units of velocity_scale
  double worst_factor = 16;   ///< the worst contact may be this many times worse (as LMGC90's QM/16)
  double velocity_scale = 0;  ///< [m/s]; for particles: diameter / time step, so that the violation is the
                              ///< overlap gained in a step over a diameter. 0: rms of u_c - W_cc p_c at
                              ///< the start, which from p = 0 is q.
  double relaxation = 1;      ///< omega of p <- p + omega (p_new - p), in (0, 2) without friction
  bool extrapolated = false;  ///< NLGS starts each sweep ahead of the last, see Extrapolation
  int check_every = 10;  ///< iterations of Nesterov's method between two looks at the violation; NLGS sees
                         ///< it in passing, in every sweep
};

/// What a contact algorithm reached. Not converged is a value, not an exception.
struct SolverReport {
  int sweeps = 0;
  double residual_mean = 0;  ///< rms violation over contacts that carry impulse or are violated [-]
  double residual_max = 0;   ///< worst contact [-]
  bool converged = false;
};

}  // namespace softgrain
