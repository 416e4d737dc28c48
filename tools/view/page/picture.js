// The picture: draws the server's frames and keeps the scene's size to that of its place in the window.
// SPDX-License-Identifier: Apache-2.0
const kResizeMs = 150;  // a window that is being dragged is asked for when it rests
const kLeast = 16;      // pixels
const kRounding = 0.04;

// Returns how large a frame is drawn in a picture. A draft's size is rounded to whole pixels and is stretched by that
// little; a frame from before the picture got other proportions keeps its own.
function drawnSize(header, width, height) {
  const across = width / header.width, down = height / header.height;
  if (Math.abs(across / down - 1) < kRounding) return [width, height];
  const factor = Math.min(across, down);
  return [header.width * factor, header.height * factor];
}

export class Picture {
  /// @param stage   the element in which the picture lies
  /// @param canvas  in the stage
  constructor(stage, canvas, session, problem) {
    Object.assign(this, { stage_: stage, canvas, session_: session, problem_: problem });
    this.followsWindow = true;
    this.shownFrame_ = -1;
    new ResizeObserver(() => this.windowChanged_()).observe(stage);
    session.on("change", () => {
      if (String(session.scene.camera.size) !== this.fitted_) this.fit_();
    });
    session.on("edited", ({ patch, step }) => {
      if (patch.camera?.size && step !== "size") this.setFollowsWindow(false);
    });
  }

  setFollowsWindow(follows) {
    this.followsWindow = follows;
    this.onFollow?.(follows);
    if (follows) this.askForWindowSize();
  }

  /// Draws a frame; resolves when it is on the page, or when it turned out to be none.
  async show({ header, bytes }) {
    try {
      const image = await createImageBitmap(new Blob([bytes], { type: header.mime }));
      if (header.frame > this.shownFrame_) this.draw_(image, header);
      image.close();
    } catch (error) {
      this.problem_(`a picture of the server could not be shown: ${error.message}`);
    }
  }

  /// A new connection counts its frames anew.
  forget() { this.shownFrame_ = -1; }

  draw_(image, header) {
    const { canvas } = this;
    const [width, height] = this.session_.scene?.camera.size ?? [header.width, header.height];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, width, height);
    context.imageSmoothingQuality = "high";
    const [drawnWidth, drawnHeight] = drawnSize(header, width, height);
    context.drawImage(image, (width - drawnWidth) / 2, (height - drawnHeight) / 2, drawnWidth, drawnHeight);
    this.shownFrame_ = header.frame;
    Object.assign(canvas.dataset, { frame: header.frame, draft: header.draft, samples: header.samples });
    if (header.number !== undefined) canvas.dataset.number = header.number;  // of the frame of a sequence
  }

  // Makes the picture as large as fits into its place, at the scene's proportions.
  fit_() {
    const size = this.session_.scene?.camera.size;
    const { clientWidth, clientHeight } = this.stage_;
    if (!size || clientWidth === 0) return;
    this.fitted_ = String(size);
    const factor = Math.min(clientWidth / size[0], clientHeight / size[1]);
    this.canvas.style.width = `${size[0] * factor}px`;
    this.canvas.style.height = `${size[1] * factor}px`;
    this.onFit?.();
  }

  windowChanged_() {
    this.fit_();
    clearTimeout(this.timer_);
    this.timer_ = setTimeout(() => this.askForWindowSize(), kResizeMs);
  }

  /// Makes the picture as large as its place in the window, where that is wanted.
  askForWindowSize() {
    const { scene } = this.session_;
    if (!this.followsWindow || !scene) return;
    const size = [this.stage_.clientWidth, this.stage_.clientHeight].map((x) => Math.max(kLeast, Math.floor(x)));
    if (size[0] !== scene.camera.size[0] || size[1] !== scene.camera.size[1])
      this.session_.edit({ camera: { size } }, "size");
  }

  /// Returns where a pointer is: x and y from the centre to the right and up in heights of the picture, and the pixel.
  place(event) {
    const box = this.canvas.getBoundingClientRect();
    const fromLeft = event.clientX - box.left, fromTop = event.clientY - box.top;
    const size = this.session_.scene?.camera.size ?? [this.canvas.width, this.canvas.height];
    const pixel = [Math.floor((fromLeft / box.width) * size[0]), Math.floor((fromTop / box.height) * size[1])];
    return {
      x: (fromLeft - box.width / 2) / box.height,
      y: (box.height / 2 - fromTop) / box.height,
      pixel,
      inside: pixel.every((x, i) => x >= 0 && x < size[i]),
    };
  }
}
