// The pictures of a study: as a screen shows them, and their errors as colours.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "study/study_folder.h"
#include "umbrick/image/image.h"

namespace umbrick {

inline constexpr int kThumbnailHeight = 256;  // pixels, of what the page shows, at most

/// The error at which the colours of error pictures end: a fixed one per model, so that all of a study, and studies of
/// other scenes, compare. Relative to L_a.
double errorScale(Model model);

/// Over black, opaque.
void writeStudyPicture(const StudyFolder& folder, const std::string& id, const Image& picture);
/// Largest error of R, G and B of each pixel, black at 0, light yellow at `scale` and above.
void writeErrorPicture(const StudyFolder& folder, const std::string& id, const Image& test, const Image& reference,
                       double scale);
/// What the error picture of a case, or of the model at a reference, is called.
std::string errorPictureId(const std::string& id);

/// Means over blocks of pixels, so that the height is at most `height`; the image itself when it is small enough.
Image shrunk(const Image& image, int height);

}  // namespace umbrick
