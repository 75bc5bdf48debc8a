# bench.gp: the three plots of bench_plot.sh, which sets work, out and kind and prepares the files in work.
if (kind eq 'png') {
	set terminal pngcairo size 1100,520 font 'sans,11'
} else {
	set terminal svg size 1100,520 font 'sans,13' background 'white'
}
methods = system("cat ".work."/methods")
data = system("cat ".work."/data")
count = words(methods)
points = work."/points"

# A method keeps its colour (Okabe and Ito's, which colour-blind readers tell apart) and its mark in every plot.
known = 'spectral paper tucker zfp archimedean ward cook-torrance edwards spectral-effort ward-relative cook-torrance-relative edwards-relative black'
array colour[14] = ['#0072B2', '#009E73', '#D55E00', '#E69F00', '#CC79A7', '#56B4E9', '#7F7F7F', '#000000', '#00308F', '#56B4E9', '#7F7F7F', '#000000', '#BBBBBB', '#8B4513']
array shape[14] = [7, 5, 9, 11, 13, 4, 6, 8, 2, 5, 7, 9, 1, 10]
place(name) = sum [n = 1:words(known)] (word(known, n) eq name ? n : 0)
style(m) = place(word(methods, m)) > 0 ? place(word(methods, m)) : 14
own(m) = word(methods, m) eq 'paper' || word(methods, m) eq 'spectral'

set logscale x
set grid xtics ytics lc rgb '#DDDDDD' lt 1
set border 3 lc rgb '#444444'
set tics nomirror
set format x '%.0s%c'
array labels[3] = ['bytes per material', 'fit time, processor seconds', 'evaluation time, ns']
array names[3] = ['bytes', 'fit', 'evaluate']

do for [p = 1:3] {
	set output out.'-'.names[p].'.'.kind
	set multiplot layout 1,2 title 'Median over '.data font ',12'
	if (p == 1) { set format x '%.0s%c' } else { set format x '%g' }
	set xlabel labels[p]
	set tmargin at screen 0.91
	set bmargin at screen 0.12

	unset key
	set lmargin at screen 0.09
	set rmargin at screen 0.43
	set logscale y
	set format y '%g'
	set ylabel 'log RMSE of cells that can be seen (lower is better)'
	plot for [m = 1:count] points index m - 1 using p:4 with linespoints lw (own(m) ? 3 : 1.5) ps 1 pt shape[style(m)] \
		lc rgb colour[style(m)] title word(methods, m)

	set key outside right top Left reverse samplen 2
	set lmargin at screen 0.515
	set rmargin at screen 0.79
	unset logscale y
	set format y '%g'
	set ylabel 'sphere PSNR, key lights, dB (higher is better)'
	plot for [m = 1:count] points index m - 1 using p:5 with linespoints lw (own(m) ? 3 : 1.5) ps 1 pt shape[style(m)] \
		lc rgb colour[style(m)] title word(methods, m)
	unset multiplot
}
