// PNG by libpng, JPEG by libjpeg-turbo: both are fed hostile files by many, and both decode within
// a size that is known beforehand.
#include "scene/pictures.h"

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <utility>

namespace lobe::scene {
namespace {

/// Beyond this a side is not a picture's, whatever the product is.
constexpr std::size_t longest_side = 65'535;

std::optional<Picture> refuse_size(std::size_t width, std::size_t height, std::size_t most_texels)
{
    if (width > 0 && height > 0 && width <= longest_side && height <= longest_side &&
        width * height <= most_texels)
        return std::nullopt;
    return Picture{
        std::nullopt,
        fmt::format("{} x {} texels are above the limit of {}", width, height, most_texels), true};
}

Picture unreadable(std::string why) { return {std::nullopt, std::move(why), false}; }

// ---- PNG

/// What libpng's callbacks know of.
struct PngInput {
    std::string_view bytes;
    std::size_t at = 0;
    std::array<char, 128> error{};
};

/// Ancillary chunks beyond this are not kept; no texel is in them.
constexpr png_alloc_size_t most_chunk_bytes = png_alloc_size_t{1} << 22;

extern "C" {

static void read_png_bytes(png_structp png, png_bytep to, std::size_t count)
{
    auto& input = *static_cast<PngInput*>(png_get_io_ptr(png));
    if (count > input.bytes.size() - input.at) png_error(png, "the file is cut off");
    std::memcpy(to, input.bytes.data() + input.at, count);
    input.at += count;
}

[[noreturn]] static void keep_png_error(png_structp png, png_const_charp message)
{
    auto& input = *static_cast<PngInput*>(png_get_error_ptr(png));
    std::strncpy(input.error.data(), message, input.error.size() - 1);
    png_longjmp(png, 1);
}

static void ignore_png_warning(png_structp, png_const_charp) {}
}

/// The steps jump out where libpng finds an error: everything that has a destructor is owned
/// outside of them.
bool read_png_header(png_structp png, png_infop info)
{
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_read_info(png, info);
    return true;
}

/// Asks for four components of 8 or 16 bits. True if 16.
bool widen(png_structp png, png_infop info)
{
    const png_byte color = png_get_color_type(png, info);
    const bool is_wide = png_get_bit_depth(png, info) == 16;
    png_set_expand(png);
    if ((color & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png);
    png_set_add_alpha(png, is_wide ? 0xFFFF : 0xFF, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    return is_wide;
}

bool prepare_png(png_structp png, png_infop info, bool* is_wide, std::size_t* row_bytes)
{
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    *is_wide = widen(png, info);
    png_read_update_info(png, info);
    *row_bytes = png_get_rowbytes(png, info);
    return true;
}

bool read_png_rows(png_structp png, png_bytepp rows)
{
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
}

struct PngDestroy {
    png_infop* info;
    void operator()(png_struct* png) const { png_destroy_read_struct(&png, info, nullptr); }
};

Picture decode_png(std::string_view bytes, std::size_t most_texels)
{
    PngInput input{bytes};
    png_infop info = nullptr;
    const std::unique_ptr<png_struct, PngDestroy> owned{
        png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, keep_png_error, ignore_png_warning),
        PngDestroy{&info}};
    png_structp png = owned.get();
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) return unreadable("libpng does not start");
    png_set_read_fn(png, &input, read_png_bytes);
    png_set_user_limits(png, 0x7FFFFFFF, 0x7FFFFFFF);  // refuse_size has the better words
    png_set_chunk_malloc_max(png, most_chunk_bytes);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    const auto failed = [&] { return unreadable(fmt::format("PNG: {}", input.error.data())); };

    if (!read_png_header(png, info)) return failed();
    const std::size_t width = png_get_image_width(png, info);
    const std::size_t height = png_get_image_height(png, info);
    if (auto refused = refuse_size(width, height, most_texels)) return *refused;
    Raster raster{static_cast<int>(width), static_cast<int>(height), false, {}};
    std::size_t row_bytes = 0;
    if (!prepare_png(png, info, &raster.is_wide, &row_bytes)) return failed();
    if (row_bytes != width * (raster.is_wide ? 8 : 4)) return unreadable("PNG: odd components");
    raster.bytes.resize(row_bytes * height);
    std::vector<png_bytep> rows(height);
    for (std::size_t row = 0; row < height; ++row) rows[row] = &raster.bytes[row * row_bytes];
    if (!read_png_rows(png, rows.data())) return failed();
    return {std::move(raster), "", false};
}

// ---- PNG, written

extern "C" {

static void append_png_bytes(png_structp png, png_bytep from, std::size_t count)
{
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(from), count);
}

static void flush_nothing(png_structp) {}
}

bool write_png(png_structp png, png_infop info, const PngTexels& texels, int level, png_bytepp rows)
{
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    constexpr int unfiltered = PNG_FILTER_NONE;
    const int color = texels.components == 1   ? PNG_COLOR_TYPE_GRAY
                      : texels.components == 3 ? PNG_COLOR_TYPE_RGB
                                               : PNG_COLOR_TYPE_RGB_ALPHA;
    png_set_IHDR(png, info, static_cast<png_uint_32>(texels.width),
                 static_cast<png_uint_32>(texels.height), texels.is_wide ? 16 : 8, color,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, level);
    if (level == 0) png_set_filter(png, PNG_FILTER_TYPE_BASE, unfiltered);
    png_write_info(png, info);
    png_write_image(png, rows);
    png_write_end(png, nullptr);
    return true;
}

struct PngWriteDestroy {
    png_infop* info;
    void operator()(png_struct* png) const { png_destroy_write_struct(&png, info); }
};

// ---- JPEG

struct JpegDestroy {
    void operator()(void* handle) const { tjDestroy(handle); }
};

Picture decode_jpeg(std::string_view bytes, std::size_t most_texels)
{
    const std::unique_ptr<void, JpegDestroy> owned{tjInitDecompress()};
    if (!owned) return unreadable("libjpeg-turbo does not start");
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto failed = [&] {
        return unreadable(fmt::format("JPEG: {}", tjGetErrorStr2(owned.get())));
    };
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colors = 0;
    if (tjDecompressHeader3(owned.get(), data, bytes.size(), &width, &height, &subsampling,
                            &colors) != 0)
        return failed();
    if (auto refused = refuse_size(static_cast<std::size_t>(width),
                                   static_cast<std::size_t>(height), most_texels))
        return *refused;
    Raster raster{width, height, false, {}};
    raster.bytes.resize(std::size_t{4} * static_cast<std::size_t>(width) *
                        static_cast<std::size_t>(height));
    // A file of thousands of scans costs a pass over the picture for each; it is refused.
    constexpr int flags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS | TJFLAG_STOPONWARNING;
    if (tjDecompress2(owned.get(), data, bytes.size(), raster.bytes.data(), width, 0, height,
                      TJPF_RGBA, flags) != 0)
        return failed();
    return {std::move(raster), "", false};
}

}  // namespace

Picture decode(std::string_view bytes, std::size_t most_texels)
{
    if (bytes.starts_with("\x89PNG\r\n\x1A\n")) return decode_png(bytes, most_texels);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decode_jpeg(bytes, most_texels);
    if (bytes.starts_with("\xABKTX 20\xBB")) return unreadable("KTX2 is not decoded");
    if (bytes.starts_with("RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP")
        return unreadable("WebP is not decoded");
    if (bytes.starts_with("DDS ")) return unreadable("DDS is not decoded");
    return unreadable("these bytes are neither PNG nor JPEG");
}

std::string encode_png(const PngTexels& texels, bool is_packed)
{
    const auto height = static_cast<std::size_t>(texels.height);
    const std::size_t row_bytes = texels.bytes.size() / height;
    assert(row_bytes ==
           static_cast<std::size_t>(texels.width * texels.components) * (texels.is_wide ? 2 : 1));
    std::vector<png_bytep> rows(height);
    for (std::size_t row = 0; row < height; ++row)
        rows[row] =
            const_cast<png_bytep>(&texels.bytes[row * row_bytes]);  // libpng only reads them

    std::string file;
    PngInput errors{};
    png_infop info = nullptr;
    const std::unique_ptr<png_struct, PngWriteDestroy> owned{
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &errors, keep_png_error, ignore_png_warning),
        PngWriteDestroy{&info}};
    png_structp png = owned.get();
    if (png != nullptr) info = png_create_info_struct(png);
    constexpr int stored = 0;
    constexpr int thorough = 6;  // zlib's own default
    [[maybe_unused]] bool is_written = false;
    if (info != nullptr) {
        png_set_write_fn(png, &file, append_png_bytes, flush_nothing);
        is_written = write_png(png, info, texels, is_packed ? thorough : stored, rows.data());
    }
    assert(is_written);  // memory is all that it needs
    return file;
}

}  // namespace lobe::scene
