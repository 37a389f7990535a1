// Words that an identifier must not be, per language: keywords (those set aside for later too),
// and builtin functions, which some compilers let a name shadow and others do not.
#include "emit/dialect.h"

namespace lobe::emit {
namespace {

// [GLSL45] 3.6, [ESSL31] 3.6, 8: both, and what either keeps for later.
constexpr std::string_view glsl[] = {
    // clang-format off
    "active", "asm", "atomic_uint", "attribute", "bool", "break", "buffer", "bvec2", "bvec3",
    "bvec4", "case", "cast", "centroid", "class", "coherent", "common", "const", "continue",
    "default", "discard", "dmat2", "dmat3", "dmat4", "do", "double", "dvec2", "dvec3", "dvec4",
    "else", "enum", "extern", "external", "f16vec2", "f16vec3", "f16vec4", "false", "filter",
    "fixed", "flat", "float", "float16_t", "for", "fvec2", "fvec3", "fvec4", "goto", "half",
    "highp", "hvec2", "hvec3", "hvec4", "if", "image1D", "image2D", "image3D", "imageCube", "in",
    "inline", "inout", "input", "int", "interface", "invariant", "isampler2D", "ivec2", "ivec3",
    "ivec4", "layout", "long", "lowp", "mat2", "mat3", "mat4", "mediump", "namespace", "noinline",
    "noperspective", "out", "output", "partition", "patch", "precise", "precision", "public",
    "readonly", "resource", "restrict", "return", "sample", "sampler", "sampler1D", "sampler2D",
    "sampler3D", "samplerCube", "shared", "short", "sizeof", "smooth", "static", "struct",
    "subroutine", "superp", "switch", "template", "texture", "this", "true", "typedef", "uint",
    "uniform", "union", "unsigned", "using", "uvec2", "uvec3", "uvec4", "varying", "vec2", "vec3",
    "vec4", "void", "volatile", "while", "writeonly",
    // functions
    "abs", "acos", "acosh", "all", "any", "asin", "asinh", "atan", "atanh", "ceil", "clamp", "cos",
    "cosh", "cross", "dFdx", "dFdy", "degrees", "determinant", "distance", "dot", "equal", "exp",
    "exp2", "faceforward", "floor", "fma", "fract", "frexp", "fwidth", "greaterThan",
    "greaterThanEqual", "interpolateAtCentroid", "inverse", "inversesqrt", "isinf", "isnan",
    "ldexp", "length", "lessThan", "lessThanEqual", "log", "log2", "main", "matrixCompMult", "max",
    "memoryBarrier", "min", "mix", "mod", "modf", "noise1", "normalize", "not", "notEqual",
    "outerProduct", "packHalf2x16", "pow", "radians", "reflect", "refract", "round", "roundEven",
    "sign", "sin", "sinh", "smoothstep", "sqrt", "step", "tan", "tanh", "texelFetch",
    "textureGrad", "textureLod", "textureSize", "transpose", "trunc", "unpackHalf2x16",
    // clang-format on
};

// Keywords, words set aside, and intrinsic functions of HLSL through shader model 6. Those of the
// effect language are reserved in any case.
constexpr std::string_view hlsl[] = {
    // clang-format off
    "AppendStructuredBuffer", "Asm", "asm", "asm_fragment", "auto", "BlendState", "bool", "break",
    "Buffer", "ByteAddressBuffer", "case", "cast", "catch", "cbuffer", "centroid", "char", "class",
    "column_major", "Compile", "compile", "compile_fragment", "CompileShader", "const", "const_cast",
    "continue", "ComputeShader", "ConstantBuffer", "ConsumeStructuredBuffer", "default", "delete",
    "DepthStencilState", "DepthStencilView", "discard", "do", "double", "DomainShader", "dword",
    "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false", "float", "float2",
    "float3", "float4", "for", "friend", "fxgroup", "GeometryShader", "globallycoherent", "goto",
    "groupshared", "half", "half2", "half3", "half4", "Hullshader", "if", "in", "inline", "inout",
    "InputPatch", "int", "int2", "int3", "int4", "interface", "line", "lineadj", "linear",
    "LineStream", "long", "matrix", "min10float", "min12int", "min16float", "min16int", "min16uint",
    "mutable", "namespace", "new", "nointerpolation", "noperspective", "NULL", "operator", "out",
    "OutputPatch", "packoffset", "Pass", "pass", "pixelfragment", "PixelShader", "point", "PointStream",
    "precise", "private", "protected", "public", "RasterizerState", "register",
    "reinterpret_cast", "RenderTargetView", "return", "row_major", "RWBuffer",
    "RWByteAddressBuffer", "RWStructuredBuffer", "RWTexture2D", "sample", "Sampler", "sampler",
    "SamplerState", "shared", "short", "signed", "sizeof", "snorm", "stateblock", "static",
    "static_cast", "string", "struct", "StructuredBuffer", "switch", "tbuffer", "Technique", "technique",
    "technique10", "technique11", "template", "Texture", "texture", "Texture1D", "Texture2D", "Texture3D",
    "TextureCube", "this", "throw", "triangle", "triangleadj", "TriangleStream", "true", "try",
    "typedef", "typename", "uint", "uniform", "union", "unorm", "unsigned", "using", "vector",
    "vertexfragment", "VertexShader", "virtual", "void", "volatile", "while",
    // functions
    "abort", "abs", "acos", "all", "any", "asdouble", "asfloat", "asin", "asint", "asuint", "atan",
    "atan2", "ceil", "clamp", "clip", "cos", "cosh", "countbits", "cross", "ddx", "ddy", "degrees",
    "determinant", "distance", "dot", "dst", "errorf", "exp", "exp2", "f16tof32", "f32tof16",
    "faceforward", "firstbithigh", "firstbitlow", "floor", "fma", "fmod", "frac", "frexp",
    "fwidth", "isfinite", "isinf", "isnan", "ldexp", "length", "lerp", "lit", "log", "log10",
    "log2", "mad", "main", "max", "min", "modf", "msad4", "mul", "noise", "normalize", "pow",
    "printf", "radians", "rcp", "reflect", "refract", "reversebits", "round", "rsqrt", "saturate",
    "sign", "sin", "sincos", "sinh", "smoothstep", "sqrt", "step", "tan", "tanh", "tex2D",
    "transpose", "trunc",
    // clang-format on
};

// Macros, types and global names that the engine's shaders have in scope.
constexpr std::string_view unreal[] = {
    // clang-format off
    "Acos", "AcosFast", "AsinFast", "BRANCH", "BxDFContext", "ClampedPow", "D_Beckmann", "D_Blinn",
    "D_GGX", "D_GGXaniso", "Diffuse_Burley", "Diffuse_Lambert", "Diffuse_OrenNayar",
    "DualSpecularGGX", "EnergyNormalization", "EnvBRDF", "EnvBRDFApprox", "F_Fresnel", "F_None",
    "F_Schlick", "FAreaLight", "FDirectLighting", "FGBufferData", "FLATTEN", "FRect", "FShadowTerms",
    "Init", "IsAreaLight", "LOOP", "Luminance", "Material", "MaterialFloat", "MaxHalfFloat",
    "PhongShadingPow", "PI", "Pow2", "Pow3", "Pow4", "Pow5", "Pow6", "Primitive",
    "RectGGXApproxLTC", "ResolvedView", "SpecularGGX", "SphereMaxNoH", "Square", "UNROLL", "View", "Vis_Cloth", "Vis_Implicit", "Vis_Kelemen", "Vis_Neumann", "Vis_Schlick",
    "Vis_Smith", "Vis_SmithJoint", "Vis_SmithJointApprox",
    // clang-format on
};

}  // namespace

Words glsl_words() { return {std::begin(glsl), std::end(glsl)}; }
Words hlsl_words() { return {std::begin(hlsl), std::end(hlsl)}; }
Words unreal_words() { return {std::begin(unreal), std::end(unreal)}; }

}  // namespace lobe::emit
