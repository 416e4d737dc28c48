// A shader program from the embedded shaders, specialised by constants.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <span>
#include <string>

#include "umbrick/gl/functions.h"

namespace umbrick {

/// Values of `const int` names that a shader expects, fixed when it is compiled: what a scene does not use costs
/// nothing.
using ShaderConstants = std::map<std::string, int>;

class GlProgram {
 public:
  /// @param vertex, fragment  paths below shaders/, e.g. "shade/slice.vert"
  /// @throw GlError  no such shader, or the driver's message with our file and line
  GlProgram(const GlFunctions& gl, const std::string& vertex, const std::string& fragment,
            const ShaderConstants& constants = {});
  /// A compute program, e.g. of "shade/window_march.comp". @throw GlError  likewise
  static GlProgram compute(const GlFunctions& gl, const std::string& path, const ShaderConstants& constants = {});
  ~GlProgram();
  GlProgram(GlProgram&& other) noexcept;
  GlProgram& operator=(GlProgram&& other) noexcept;

  void use() const;
  // A name that the compiler removed because nothing reads it is ignored.
  void set(const char* name, int value);
  void set(const char* name, float value);
  void set(const char* name, const glm::ivec2& value);
  void set(const char* name, const glm::vec2& value);
  void set(const char* name, const glm::vec3& value);
  void set(const char* name, const glm::vec4& value);
  void set(const char* name, std::span<const glm::vec3> values);
  void set(const char* name, std::span<const glm::vec4> values);

 private:
  explicit GlProgram(const GlFunctions& gl) : gl_(&gl) {}
  void link(std::span<const GLuint> shaders, const std::string& names);
  GLint location(const char* name);
  const GlFunctions* gl_;
  GLuint name_ = 0;
  std::map<std::string, GLint> locations_;
};

/// The text of a shader with its includes and constants, as it goes to the driver: for messages and tests.
/// @throw GlError  no such shader, or one that includes itself
std::string shaderSource(const std::string& path, const ShaderConstants& constants = {});

}  // namespace umbrick
