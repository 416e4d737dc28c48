// The light of paths where planes cut the medium. The CPU's is in src/light/sweep_kernels.cpp, by the same formulas.
// SPDX-License-Identifier: Apache-2.0

// Light outside of a cut is continued over so many voxels. Where the next one within lies nearer to the cut than kNear,
// the slope is that over kNear. Behind the medium light goes on falling for kBehind slices.
const float kBeyond = 3.0;
const float kNear = 0.125;
const float kBehind = 2.0;
// Paths of this optical depth are dark, and no longer followed.
const float kDarkDepth = 24.0;

float expNegative(float x) { return x < kDarkDepth ? exp(-x) : 0.0; }

// (1 - exp(-x)) / x, and the means of 1 - t and of t with the weight exp(-x t) over t in [0, 1].
struct Means {
  float whole, first, last;
};
Means meansOver(float x) {
  Means means;
  if (x < 0.25) {  // power series where differences would cancel
    means.whole = 1.0 + x * (-0.5 + x * (1.0 / 6.0 + x * (-1.0 / 24.0 + x * (1.0 / 120.0))));
    means.last = 0.5 + x * (-1.0 / 3.0 + x * (1.0 / 8.0 + x * (-1.0 / 30.0 + x * (1.0 / 144.0))));
  } else {
    float e = expNegative(x);
    means.whole = (1.0 - e) / x;
    means.last = (means.whole - e) / x;
  }
  means.first = means.whole - means.last;
  return means;
}

// How much more light than arrives there is at so many voxels outside of a cut, so that what is read linearly between
// there and the first voxel within looks as bright to an eye that looks straight at the cut as what falls off from the
// cut on. tau, eye: optical depths of the way between two voxels, for light and eye.
float continued(float outside, float tau, float eye) {
  float way = clamp(outside, 0.0, kBeyond), within = max(ceil(way) - way, kNear);
  float next = expNegative(tau * within);
  Means means = meansOver(eye * within);
  float cut = (meansOver((eye + tau) * within).whole - next * means.last) / means.first;
  return cut + way * (cut - next) / within;
}

// The part of a path that lies in the medium, in slices from the present one on.
struct Kept {
  float enter, leave;
  float per_place, cosine;  // of the plane where it enters, see PathCut of umbrick/light/light_paths.h
};

// Returns the transmittance of a path that is on the present slice with this optical depth, where sigma_t is as given.
float throughCut(Kept kept, float depth, float sigma_t, float slice_length) {
  float behind = clamp(-kept.leave, 0.0, kBehind);
  float light = expNegative(depth + slice_length * behind * sigma_t), far = kept.enter / kept.per_place;
  if (far <= 0.0 || far >= kBeyond) return light;
  float tau = sigma_t * slice_length * kept.per_place;
  return light * continued(far, tau, tau * kept.cosine);
}
