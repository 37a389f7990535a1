#include "analyze/environment/baked_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobe::analyze {
namespace {

/// Texels in double, component by component, and how a texture unit reads between them.
class TexelGrid {
public:
    TexelGrid(const BakeSubject& subject, std::size_t height)
        : across_(subject.axes.front()), width_(across_.size), height_(height)
    {
        if (subject.axes.size() == 2) down_ = subject.axes[1];
    }

    /// `steps`: weights are multiples of its inverse; 0: exact.
    double read(const std::vector<double>& texels, Place at, double steps) const
    {
        const Between across = between(across_.texel_of(at.x), width_, steps);
        const Between down =
            height_ == 1 ? Between{} : between(down_.texel_of(at.y), height_, steps);
        const auto line = [&](std::size_t y) {
            const double* const first = &texels[y * width_];
            return std::lerp(first[across.texel], first[std::min(across.texel + 1, width_ - 1)],
                             across.weight);
        };
        return std::lerp(line(down.texel), line(std::min(down.texel + 1, height_ - 1)),
                         down.weight);
    }

private:
    /// A texel, and how much of the next one is read.
    struct Between {
        std::size_t texel = 0;
        double weight = 0;
    };

    static Between between(double place, std::size_t size, double steps)
    {
        const double low = std::floor(std::min(place, static_cast<double>(size - 1)));
        double weight = place - low;
        if (steps > 0) weight = std::floor(weight * steps + 0.5) / steps;
        return {static_cast<std::size_t>(low), weight};
    }

    TableAxis across_;
    TableAxis down_;
    std::size_t width_;
    std::size_t height_;
};

/// Arguments along an axis to measure at: between all texels, as many steps each as `most` allows,
/// or in the middle between evenly chosen ones; and the ends.
std::vector<double> lattice(const TableAxis& axis, std::size_t most)
{
    std::vector<double> texels;
    const std::size_t gaps = axis.size - 1;
    if (2 * gaps <= most) {
        const std::size_t steps = gaps == 0 ? 1 : std::min<std::size_t>(most / gaps, 64);
        for (std::size_t i = 0; i < gaps * steps; ++i)
            texels.push_back(static_cast<double>(i) / static_cast<double>(steps));
        texels.push_back(static_cast<double>(gaps));
    } else {
        for (std::size_t i = 0; i < most; ++i)
            texels.push_back(static_cast<double>(i * gaps / most) + 0.5);
    }
    std::vector<double> out{axis.low, axis.high};
    if (axis.places == TexelPlaces::centers)
        for (const double beyond : {-0.25, static_cast<double>(gaps) + 0.25})
            out.push_back(axis.at(beyond));
    for (const double texel : texels) out.push_back(axis.at(texel));
    for (double& argument : out) argument = std::clamp(argument, axis.low, axis.high);
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    // Outside the argument's range there is nothing to be right about.
    std::erase_if(out, [&](double at) { return at < axis.least || at > axis.greatest; });
    return out;
}

std::vector<Place> places_of(const std::vector<double>& across, const std::vector<double>& down)
{
    std::vector<Place> out;
    for (const double y : down)
        for (const double x : across) out.push_back({x, y});
    return out;
}

std::vector<double> texel_arguments(const TableAxis& axis)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < axis.size; ++i)
        out.push_back(std::clamp(axis.at(static_cast<double>(i)), axis.least, axis.greatest));
    return out;
}

class ErrorSum {
public:
    void add(double error, Place at)
    {
        const double size = std::fabs(error);
        if (!(size <= sum_.worst)) {
            sum_.worst = size;
            sum_.at = at;
        }
        squares_ += error * error;
        ++count_;
    }
    BakeError result() const
    {
        BakeError out = sum_;
        if (count_ > 0) out.root_mean_square = std::sqrt(squares_ / count_);
        return out;
    }

private:
    BakeError sum_;
    double squares_ = 0;
    double count_ = 0;
};

/// Why a component's texels do not fit a format, or empty.
std::string misfit(const std::string& name, const TexelFormat& format,
                   const std::vector<double>& texels)
{
    // A little beyond is clamped, and shows as an error of storing.
    const bool unorm = format.kind == TexelKind::unorm8 || format.kind == TexelKind::unorm16;
    const double slack = unorm ? 0.01 : 0;
    for (const double value : texels)
        if (!std::isfinite(value)) return fmt::format("`{}` is not finite at a texel", name);
    const auto [low, high] = std::ranges::minmax(texels);
    const bool over = high > greatest_of(format.kind) + slack;
    if (over || low < least_of(format.kind) - slack)
        return fmt::format("`{}` reaches {:.6g}, and {} holds {} to {}", name, over ? high : low,
                           format.reads, least_of(format.kind), greatest_of(format.kind));
    return {};
}

}  // namespace

double TableAxis::at(double texel) const
{
    const auto texels = static_cast<double>(size);
    const double share =
        places == TexelPlaces::ends ? texel / (texels - 1) : (texel + 0.5) / texels;
    return std::lerp(low, high, share);
}

double TableAxis::texel_of(double argument) const
{
    const double coordinate = argument * scale() + offset();
    const auto texels = static_cast<double>(size);
    return std::clamp(coordinate * texels - 0.5, 0.0, texels - 1);
}

double TableAxis::scale() const
{
    const auto texels = static_cast<double>(size);
    return (places == TexelPlaces::ends ? (texels - 1) / texels : 1) / (high - low);
}

double TableAxis::offset() const
{
    return (places == TexelPlaces::ends ? 0.5 / static_cast<double>(size) : 0) - low * scale();
}

std::size_t BakedTable::bytes() const
{
    return codes.size() * static_cast<std::size_t>(bytes_of(format.kind));
}

double BakedTable::stored(std::size_t texel, std::size_t channel) const
{
    return decoded(codes[texel * static_cast<std::size_t>(format.channels) + channel], format.kind);
}

std::optional<BakedTable> bake(const BakeSubject& subject, const TexelFormat& format,
                               std::size_t points, std::string& why)
{
    const std::size_t channels = static_cast<std::size_t>(format.channels);
    if (subject.components.size() > channels) {
        why = fmt::format("`{}` has {} components, and {} holds {}", subject.name,
                          subject.components.size(), format.reads, channels);
        return std::nullopt;
    }
    BakedTable out;
    out.subject = subject;
    out.format = format;

    const bool flat = subject.axes.size() == 1;
    const auto rows = flat ? std::vector<double>{0} : texel_arguments(subject.axes[1]);
    const std::vector<Place> texels = places_of(texel_arguments(subject.axes[0]), rows);
    const auto values = subject.texels(texels);

    out.codes.assign(texels.size() * channels, 0);
    for (std::size_t texel = 0; texel < texels.size() && channels == 4; ++texel)
        out.codes[texel * 4 + 3] = code_of(1, format.kind);
    for (std::size_t k = 0; k < values.size(); ++k) {
        why = misfit(subject.components[k], format, values[k]);
        if (!why.empty()) return std::nullopt;
        for (std::size_t texel = 0; texel < texels.size(); ++texel)
            out.codes[texel * channels + k] = code_of(values[k][texel], format.kind);
    }

    const std::size_t most = flat ? points : static_cast<std::size_t>(std::sqrt(points));
    const std::vector<Place> between =
        places_of(lattice(subject.axes[0], most),
                  flat ? std::vector<double>{0} : lattice(subject.axes[1], most));
    const auto exact = subject.exact(between);
    out.points = between.size();
    const TexelGrid grid{subject, out.height()};
    for (std::size_t k = 0; k < values.size(); ++k) {
        std::vector<double> stored(texels.size());
        ErrorSum storage;
        for (std::size_t texel = 0; texel < texels.size(); ++texel) {
            stored[texel] = out.stored(texel, k);
            storage.add(stored[texel] - values[k][texel], texels[texel]);
        }
        ErrorSum interpolation;
        ErrorSum together;
        for (std::size_t i = 0; i < between.size(); ++i) {
            interpolation.add(grid.read(values[k], between[i], 0) - exact[k][i], between[i]);
            together.add(grid.read(stored, between[i], 256) - exact[k][i], between[i]);
        }
        out.components.push_back(
            {subject.components[k], storage.result(), interpolation.result(), together.result()});
    }
    return out;
}

}  // namespace lobe::analyze
