// Writes the pictures of a study as PNG files: as a screen shows them, and their errors as colours.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "study_page/page_folder.h"
#include "umbrick/image/image.h"
#include "umbrick/study/study.h"

namespace umbrick::tools {

inline constexpr int kThumbnailHeight = 256;  // pixels, of the pictures that the page shows, at most

/// Returns the error at which the colours of error pictures end, relative to L_a. It is fixed for each model, so that
/// pictures of one study, and of studies of other scenes, can be compared.
double errorScale(Model model);

/// Writes a picture over black, opaque. Where it is compared with a truth, also writes its error: the largest of R, G
/// and B of each pixel, black at 0, light yellow at errorScale and above.
/// @param ambient  L_a of the scene, linear RGB
void writePictures(const PageFolder& folder, const StudyPicture& picture, const glm::dvec3& ambient);
/// Returns the name of the error picture of a case, or of the model at a reference.
std::string errorPictureId(const std::string& id);

/// Returns means over blocks of pixels, so that the height is at most `height`; the image itself when it
/// is small enough.
Image shrunk(const Image& image, int height);

}  // namespace umbrick::tools
