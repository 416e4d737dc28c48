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

/// Values of the `const int` names that a shader expects. They are fixed when the shader is compiled, so that what a
/// scene does not use costs nothing.
using ShaderConstants = std::map<std::string, int>;

class GlProgram {
 public:
  /// @param vertex, fragment  paths below shaders/, such as "shade/slice.vert"
  /// @throw GlError  there is no such shader, or it does not compile: the driver's message with our file and line
  GlProgram(const GlFunctions& gl, const std::string& vertex, const std::string& fragment,
            const ShaderConstants& constants = {});
  /// Makes a compute program, for example of "shade/window_march.comp". @throw GlError  as the constructor
  static GlProgram compute(const GlFunctions& gl, const std::string& path, const ShaderConstants& constants = {});
  ~GlProgram();
  GlProgram(GlProgram&& other) noexcept;
  GlProgram& operator=(GlProgram&& other) noexcept;

  void use() const;
  // A name that the compiler removed because nothing reads it is ignored.
  void set(const char* name, int value);
  void set(const char* name, float value);
  void set(const char* name, const glm::ivec2& value);
  void set(const char* name, const glm::ivec3& value);
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

/// Returns the text of a shader with its includes and constants, as it goes to the driver. Messages and tests need it.
/// @throw GlError  there is no such shader, or it includes itself
std::string shaderSource(const std::string& path, const ShaderConstants& constants = {});

}  // namespace umbrick
