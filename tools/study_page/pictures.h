// The pictures of a study as PNG files: as a screen shows them, and their errors as colours.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "study_page/page_folder.h"
#include "umbrick/image/image.h"
#include "umbrick/study/study.h"

namespace umbrick::tools {

inline constexpr int kThumbnailHeight = 256;  // pixels, of what the page shows, at most

/// The error at which the colours of error pictures end: a fixed one per model, so that all of a study, and studies of
/// other scenes, compare. Relative to L_a.
double errorScale(Model model);

/// Writes a picture over black, opaque, and, where it is compared with a truth, its error: the largest of R, G and B of
/// each pixel, black at 0, light yellow at errorScale and above.
/// @param ambient  L_a of the scene, linear RGB
void writePictures(const PageFolder& folder, const StudyPicture& picture, const glm::dvec3& ambient);
/// What the error picture of a case, or of the model at a reference, is called.
std::string errorPictureId(const std::string& id);

/// Means over blocks of pixels, so that the height is at most `height`; the image itself when it is small enough.
Image shrunk(const Image& image, int height);

}  // namespace umbrick::tools
