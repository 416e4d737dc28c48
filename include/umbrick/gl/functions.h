// The OpenGL functions that Umbrick calls, loaded from whichever library made the context.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <GL/glcorearb.h>

#include <functional>

namespace umbrick {

// clang-format off
#define UMBRICK_GL_FUNCTIONS(X) \
  X(GETSTRING, GetString) X(GETINTEGERV, GetIntegerv) X(GETINTEGER64V, GetInteger64v) X(GETERROR, GetError) \
  X(FINISH, Finish) X(FLUSH, Flush) X(VIEWPORT, Viewport) X(SCISSOR, Scissor) X(ENABLE, Enable) X(DISABLE, Disable) \
  X(ENABLEI, Enablei) X(DISABLEI, Disablei) X(BLENDFUNCI, BlendFunci) X(COLORMASKI, ColorMaski) \
  X(DEPTHFUNC, DepthFunc) X(DEPTHMASK, DepthMask) X(STENCILFUNC, StencilFunc) X(STENCILOP, StencilOp) \
  X(STENCILMASK, StencilMask) X(PIXELSTOREI, PixelStorei) \
  X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv) X(CLEARNAMEDFRAMEBUFFERFI, ClearNamedFramebufferfi) X(CLEARNAMEDFRAMEBUFFERIV, ClearNamedFramebufferiv) \
  X(CREATETEXTURES, CreateTextures) X(DELETETEXTURES, DeleteTextures) X(BINDTEXTUREUNIT, BindTextureUnit) \
  X(TEXTURESTORAGE1D, TextureStorage1D) X(TEXTURESTORAGE2D, TextureStorage2D) X(TEXTURESTORAGE3D, TextureStorage3D) \
  X(TEXTURESUBIMAGE1D, TextureSubImage1D) X(TEXTURESUBIMAGE2D, TextureSubImage2D) \
  X(TEXTURESUBIMAGE3D, TextureSubImage3D) X(TEXTUREPARAMETERI, TextureParameteri) \
  X(GETTEXTUREIMAGE, GetTextureImage) X(COPYIMAGESUBDATA, CopyImageSubData) \
  X(BINDBUFFER, BindBuffer) X(BINDSAMPLER, BindSampler) X(BLENDEQUATION, BlendEquation) X(POLYGONMODE, PolygonMode) \
  X(CREATEBUFFERS, CreateBuffers) X(DELETEBUFFERS, DeleteBuffers) X(NAMEDBUFFERDATA, NamedBufferData) \
  X(NAMEDBUFFERSUBDATA, NamedBufferSubData) X(GETNAMEDBUFFERSUBDATA, GetNamedBufferSubData) \
  X(CLEARNAMEDBUFFERDATA, ClearNamedBufferData) X(CLEARTEXIMAGE, ClearTexImage) \
  X(CREATEVERTEXARRAYS, CreateVertexArrays) X(DELETEVERTEXARRAYS, DeleteVertexArrays) \
  X(BINDVERTEXARRAY, BindVertexArray) X(VERTEXARRAYVERTEXBUFFER, VertexArrayVertexBuffer) \
  X(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer) X(VERTEXARRAYATTRIBFORMAT, VertexArrayAttribFormat) \
  X(VERTEXARRAYATTRIBBINDING, VertexArrayAttribBinding) X(ENABLEVERTEXARRAYATTRIB, EnableVertexArrayAttrib) \
  X(CREATEFRAMEBUFFERS, CreateFramebuffers) X(DELETEFRAMEBUFFERS, DeleteFramebuffers) \
  X(BINDFRAMEBUFFER, BindFramebuffer) X(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture) \
  X(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers) \
  X(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus) \
  X(CREATESHADER, CreateShader) X(SHADERSOURCE, ShaderSource) X(COMPILESHADER, CompileShader) \
  X(GETSHADERIV, GetShaderiv) X(GETSHADERINFOLOG, GetShaderInfoLog) X(DELETESHADER, DeleteShader) \
  X(CREATEPROGRAM, CreateProgram) X(ATTACHSHADER, AttachShader) X(LINKPROGRAM, LinkProgram) \
  X(GETPROGRAMIV, GetProgramiv) X(GETPROGRAMINFOLOG, GetProgramInfoLog) X(DELETEPROGRAM, DeleteProgram) \
  X(USEPROGRAM, UseProgram) X(GETUNIFORMLOCATION, GetUniformLocation) X(PROGRAMUNIFORM1I, ProgramUniform1i) \
  X(PROGRAMUNIFORM1F, ProgramUniform1f) X(PROGRAMUNIFORM2F, ProgramUniform2f) X(PROGRAMUNIFORM3F, ProgramUniform3f) \
  X(PROGRAMUNIFORM4F, ProgramUniform4f) X(PROGRAMUNIFORM3FV, ProgramUniform3fv) X(PROGRAMUNIFORM4FV, ProgramUniform4fv) \
  X(DRAWARRAYS, DrawArrays) X(DRAWELEMENTS, DrawElements) X(BINDBUFFERBASE, BindBufferBase) \
  X(DISPATCHCOMPUTE, DispatchCompute) X(MEMORYBARRIER, MemoryBarrier) X(BINDIMAGETEXTURE, BindImageTexture) \
  X(PROGRAMUNIFORM2I, ProgramUniform2i) X(PROGRAMUNIFORM3I, ProgramUniform3i) \
  X(CREATEQUERIES, CreateQueries) X(DELETEQUERIES, DeleteQueries) X(BEGINQUERY, BeginQuery) X(ENDQUERY, EndQuery) \
  X(GETQUERYOBJECTUI64V, GetQueryObjectui64v)
// clang-format on

/// Pointers to the functions of one context, named without the gl prefix: gl.DrawElements(...).
struct GlFunctions {
#define UMBRICK_GL_MEMBER(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
  UMBRICK_GL_FUNCTIONS(UMBRICK_GL_MEMBER)
#undef UMBRICK_GL_MEMBER
};

using GlProcedure = void (*)();

/// Loads all functions.
/// @param procedure  returns the address of a function of the current context by its full name, or null
/// @throw GlError    the driver lacks a function; the message names the first one
GlFunctions loadGlFunctions(const std::function<GlProcedure(const char*)>& procedure);

}  // namespace umbrick
