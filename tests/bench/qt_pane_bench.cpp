// Whether a Qt widget that paints with QPainter shows moving pictures fast enough: JPEG tiles of
// whole pictures come at a steady pace, a thread decodes them, the newest is painted. What METHODS
// §21.1 "A pane without GL" says is printed here. Run under a display (xvfb-run -s '-screen 0
// 2000x1200x24'). Arguments: PICTURE.png… RATE SECONDS [WIDTHxHEIGHT of the pane]
#include "encode/tile_encoder.h"
#include "stopwatch.h"
#include "tiles/picture_stream.h"

#include <QApplication>
#include <QImage>
#include <QMutex>
#include <QPainter>
#include <QWidget>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <thread>

namespace haustra {
namespace {

double threadCpuMs() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
}

/// The newest picture, from the thread that decodes to the one that paints.
struct Newest {
    QMutex mutex;
    tiles::Picture picture;
    double fedMs = 0.0;
    int replaced = 0;
};

class Pane : public QWidget {
public:
    explicit Pane(Newest& newest) : newest_(newest) {
        setAttribute(Qt::WA_OpaquePaintEvent);
        setAttribute(Qt::WA_NoSystemBackground);
    }
    std::vector<double> latencyMs;
    int painted = 0;

protected:
    void paintEvent(QPaintEvent*) override {
        double fedMs = 0.0;
        {
            const QMutexLocker lock(&newest_.mutex);
            if (newest_.picture.width > 0) shown_ = std::exchange(newest_.picture, {});
            fedMs = std::exchange(newest_.fedMs, 0.0);
        }
        const QImage image(shown_.pixels.data(), shown_.width, shown_.height, QImage::Format_RGB32);
        QPainter painter(this);
        if (image.size() == size() * devicePixelRatioF())
            painter.drawImage(0, 0, image);
        else
            painter.drawImage(rect(), image);
        painter.setPen(Qt::white);
        painter.drawText(16, 28, QStringLiteral("1234 mm"));
        painter.end();
        if (fedMs > 0.0) latencyMs.push_back(bench::milliseconds() - fedMs), ++painted;
    }

private:
    Newest& newest_;
    tiles::Picture shown_;
};

/// Decodes the frames of one picture as a session does, into what QPainter paints fastest.
tiles::Picture decoded(tiles::PictureStream& stream, std::span<const std::uint8_t> frames) {
    while (!frames.empty()) {
        const auto header = protocol::parseFrameHeader(frames.first(protocol::frameHeaderBytes),
                                                       protocol::clientReceives);
        auto picture = stream.add(frames.subspan(protocol::frameHeaderBytes, header->payloadBytes));
        if (*picture) return std::move(**picture);
        frames = frames.subspan(protocol::frameHeaderBytes + header->payloadBytes);
    }
    return {};
}

std::vector<Image> readPictures(std::span<char*> files) {
    std::vector<Image> pictures;
    for (const char* file : files) {
        const QImage read = QImage(file).convertToFormat(QImage::Format_RGB888);
        if (read.isNull()) std::fprintf(stderr, "%s: no picture\n", file), std::exit(1);
        Image& picture = pictures.emplace_back(blankImage({read.width(), read.height()}));
        for (int y = 0; y < read.height(); ++y)
            std::memcpy(&picture.rgb[std::size_t(3 * read.width() * y)], read.constScanLine(y),
                        std::size_t(3 * read.width()));
    }
    return pictures;
}

int run(std::span<char*> files, double perSecond, double seconds, QSize paneSize) {
    const std::vector<Image> pictures = readPictures(files);
    auto encoder = encode::TileEncoder::create();
    const auto framesOf = [&](std::uint32_t number) {
        protocol::TileHeader header;
        header.picture = number, header.sequence = number;
        return *encoder->encode(pictures[number % pictures.size()], header);
    };
    // Encoded before the clock starts: in a fly-through that is the server's work.
    const int count = int(perSecond * seconds);
    std::vector<std::vector<std::uint8_t>> frames;
    for (int n = 0; n < count; ++n)
        frames.push_back(framesOf(std::uint32_t(n + 1)));

    Newest newest;
    Pane pane(newest);
    pane.resize(paneSize);
    pane.show();
    double decodeCpuMs = 0.0;
    std::thread feeder([&] {
        tiles::PictureStream stream;
        const double before = threadCpuMs();
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        const auto start = std::chrono::steady_clock::now();
        for (int n = 0; n < count; ++n) {
            std::this_thread::sleep_until(start + std::chrono::duration<double>(n / perSecond));
            const double fedMs = bench::milliseconds();
            tiles::Picture picture = decoded(stream, frames[std::size_t(n)]);
            const QMutexLocker lock(&newest.mutex);
            newest.replaced += newest.picture.width > 0;
            newest.picture = std::move(picture), newest.fedMs = fedMs;
            QMetaObject::invokeMethod(
                &pane, [&pane] { pane.update(); }, Qt::QueuedConnection);
        }
        decodeCpuMs = threadCpuMs() - before;
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        QMetaObject::invokeMethod(
            qApp, [] { QCoreApplication::quit(); }, Qt::QueuedConnection);
    });
    const double uiBefore = threadCpuMs(), allBefore = bench::cpuMilliseconds();
    QCoreApplication::exec();
    const double uiCpuMs = threadCpuMs() - uiBefore;
    feeder.join();
    const double allCpuMs = bench::cpuMilliseconds() - allBefore;
    std::size_t bytes = 0;
    for (const auto& picture : frames)
        bytes += picture.size();
    std::printf(
        "%zu-byte pictures of %dx%d in a pane of %dx%d, %.0f/s for %.0f s: %d painted, %d "
        "replaced by newer ones; tile to paint p50 %.1f, p95 %.1f ms; CPU ms a picture: decoding "
        "%.2f, "
        "painting %.2f, all threads %.2f\n",
        bytes / frames.size(), pictures[0].width, pictures[0].height, paneSize.width(),
        paneSize.height(), perSecond, seconds, pane.painted, newest.replaced,
        bench::quantile(pane.latencyMs, 0.5), bench::quantile(pane.latencyMs, 0.95),
        decodeCpuMs / count, uiCpuMs / count, allCpuMs / count);
    return 0;
}

}  // namespace
}  // namespace haustra

int main(int count, char** arguments) {
    QApplication application(count, arguments);
    int width = 1920, height = 1080;
    if (count < 4 || (std::strchr(arguments[count - 1], 'x') &&
                      std::sscanf(arguments[count - 1], "%dx%d", &width, &height) != 2))
        return std::fprintf(stderr, "usage: qt_pane_bench PICTURE.png… RATE SECONDS [WxH]\n"), 2;
    if (std::strchr(arguments[count - 1], 'x')) --count;
    return haustra::run({arguments + 1, arguments + count - 2}, std::atof(arguments[count - 2]),
                        std::atof(arguments[count - 1]), QSize(width, height));
}
