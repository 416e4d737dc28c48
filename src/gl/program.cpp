// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/program.h"

#include <string_view>
#include <utility>
#include <vector>

#include "umbrick/core/error.h"

namespace umbrick {

std::string_view shaderText(std::string_view path);  // made by the build, which embeds the shaders

namespace {

// A driver is told that line n of the i-th file is line i * kLinesPerFile + n of a single file. GLSL can number files,
// but Mesa forgets the number in most of its messages.
constexpr int kLinesPerFile = 10'000;

std::string lineMark(std::size_t file, int line) {
  return "#line " + std::to_string(static_cast<int>(file) * kLinesPerFile + line) + "\n";
}

// Appends a file with its includes. `files` lists the files in the order of their first use.
void appendSource(const std::string& path, std::vector<std::string>& files, std::vector<std::string>& open,
                  std::string& out) {
  for (const std::string& outer : open)
    if (outer == path) throw GlError("shader " + path + " includes itself");
  for (const std::string& known : files)
    if (known == path) return;  // each file is taken once, as with include guards
  const std::string_view text = shaderText(path);
  if (text.empty()) throw GlError("no shader " + path);
  const std::size_t number = files.size();
  files.push_back(path);
  open.push_back(path);
  out += lineMark(number, 1);
  constexpr std::string_view kInclude = "#include \"";
  int line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view row = text.substr(at, end - at);
    at = end + 1;
    if (row.starts_with(kInclude)) {
      const std::string_view rest = row.substr(kInclude.size());
      appendSource(std::string(rest.substr(0, rest.find('"'))), files, open, out);
      out += lineMark(number, line + 1);
    } else {
      out.append(row);
      out += '\n';
    }
  }
  open.pop_back();
}

std::string expand(const std::string& path, const ShaderConstants& constants, std::vector<std::string>& files) {
  std::string out = "#version 450 core\n";
  for (const auto& [name, value] : constants) out += "const int " + name + " = " + std::to_string(value) + ";\n";
  std::vector<std::string> open;
  appendSource(path, files, open, out);
  return out;
}

// Returns a driver's message with our files and lines. Mesa writes "0:10006(19): error", others write "0(10006) :
// error" or "ERROR: 0:10006: ".
std::string withFileNames(std::string_view log, const std::vector<std::string>& files) {
  std::string out;
  for (std::size_t at = 0; at < log.size();) {
    const bool starts = at == 0 || log[at - 1] == '\n' || log[at - 1] == ' ';
    const bool marked = starts && log[at] == '0' && at + 1 < log.size() && (log[at + 1] == ':' || log[at + 1] == '(');
    std::size_t end = at + 2;
    long number = 0;
    while (marked && end < log.size() && log[end] >= '0' && log[end] <= '9' && number < 1'000'000'000)
      number = 10 * number + (log[end++] - '0');
    const auto file = static_cast<std::size_t>(number / kLinesPerFile);
    if (!marked || end == at + 2 || file >= files.size()) {
      out += log[at++];
      continue;
    }
    out += files[file] + ":" + std::to_string(number % kLinesPerFile);
    at = end + (log[at + 1] == '(' && end < log.size() && log[end] == ')' ? 1 : 0);
  }
  return out;
}

GLuint compile(const GlFunctions& gl, GLenum stage, const std::string& path, const ShaderConstants& constants) {
  std::vector<std::string> files;
  const std::string source = expand(path, constants, files);
  const char* text = source.c_str();
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  gl.DeleteShader(shader);
  throw GlError("shader " + path + ": " + withFileNames(log, files));
}

}  // namespace

std::string shaderSource(const std::string& path, const ShaderConstants& constants) {
  std::vector<std::string> files;
  return expand(path, constants, files);
}

GlProgram::GlProgram(const GlFunctions& gl, const std::string& vertex, const std::string& fragment,
                     const ShaderConstants& constants)
    : gl_(&gl) {
  GLuint shaders[2] = {compile(gl, GL_VERTEX_SHADER, vertex, {}), 0};
  try {
    shaders[1] = compile(gl, GL_FRAGMENT_SHADER, fragment, constants);
  } catch (...) {
    gl.DeleteShader(shaders[0]);
    throw;
  }
  link(shaders, "shaders " + vertex + " and " + fragment + " do");
}

GlProgram GlProgram::compute(const GlFunctions& gl, const std::string& path, const ShaderConstants& constants) {
  GlProgram program(gl);
  const GLuint shader = compile(gl, GL_COMPUTE_SHADER, path, constants);
  program.link({&shader, 1}, "shader " + path + " does");
  return program;
}

void GlProgram::link(std::span<const GLuint> shaders, const std::string& names) {
  const GlFunctions& gl = *gl_;
  name_ = gl.CreateProgram();
  for (const GLuint shader : shaders) gl.AttachShader(name_, shader);
  gl.LinkProgram(name_);
  for (const GLuint shader : shaders) gl.DeleteShader(shader);  // the program keeps it alive
  GLint linked = 0;
  gl.GetProgramiv(name_, GL_LINK_STATUS, &linked);
  if (linked) return;
  std::string log(4096, '\0');
  GLsizei length = 0;
  gl.GetProgramInfoLog(name_, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  gl.DeleteProgram(name_);
  name_ = 0;
  throw GlError(names + " not link: " + log);
}

GlProgram::~GlProgram() {
  if (name_) gl_->DeleteProgram(name_);
}
GlProgram::GlProgram(GlProgram&& other) noexcept
    : gl_(other.gl_), name_(std::exchange(other.name_, 0)), locations_(std::move(other.locations_)) {}
GlProgram& GlProgram::operator=(GlProgram&& other) noexcept {
  std::swap(gl_, other.gl_);
  std::swap(name_, other.name_);
  std::swap(locations_, other.locations_);
  return *this;
}

void GlProgram::use() const { gl_->UseProgram(name_); }

GLint GlProgram::location(const char* name) {
  const auto [entry, isNew] = locations_.try_emplace(name, -1);
  if (isNew) entry->second = gl_->GetUniformLocation(name_, name);
  return entry->second;
}

void GlProgram::set(const char* name, int value) { gl_->ProgramUniform1i(name_, location(name), value); }
void GlProgram::set(const char* name, float value) { gl_->ProgramUniform1f(name_, location(name), value); }
void GlProgram::set(const char* name, const glm::ivec2& v) { gl_->ProgramUniform2i(name_, location(name), v.x, v.y); }
void GlProgram::set(const char* name, const glm::ivec3& v) {
  gl_->ProgramUniform3i(name_, location(name), v.x, v.y, v.z);
}
void GlProgram::set(const char* name, const glm::vec2& v) { gl_->ProgramUniform2f(name_, location(name), v.x, v.y); }
void GlProgram::set(const char* name, const glm::vec3& v) {
  gl_->ProgramUniform3f(name_, location(name), v.x, v.y, v.z);
}
void GlProgram::set(const char* name, const glm::vec4& v) {
  gl_->ProgramUniform4f(name_, location(name), v.x, v.y, v.z, v.w);
}
void GlProgram::set(const char* name, std::span<const glm::vec3> values) {
  if (!values.empty()) gl_->ProgramUniform3fv(name_, location(name), static_cast<GLsizei>(values.size()), &values[0].x);
}
void GlProgram::set(const char* name, std::span<const glm::vec4> values) {
  if (!values.empty()) gl_->ProgramUniform4fv(name_, location(name), static_cast<GLsizei>(values.size()), &values[0].x);
}

}  // namespace umbrick
