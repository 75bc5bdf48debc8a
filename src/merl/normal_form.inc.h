/*
 * Canonical decompositions of the Basic Multilingual Plane, by mark: {mark, pairs of a composed character and its base}; mark 0:
 * none. From the Unicode Character Database (version 14.0.0, as Python's unicodedata gives it), without Hangul, which is
 * arithmetic, and without the compatibility ideographs. Numbers stand for what runs from right to left, cannot stand alone, or
 * has a twin that looks the same.
 */
// clang-format off
{0, u"\u0340\u0300\u0341\u0301\u0343\u0313\u0374\u02B9\u037E;\u0387\u00B7\u1F71\u03AC\u1F73\u03AD\u1F75\u03AE\u1F77\u03AF"
  u"\u1F79\u03CC\u1F7B\u03CD\u1F7D\u03CE\u1FBB\u0386\u1FBE\u03B9\u1FC9\u0388\u1FCB\u0389\u1FD3\u0390\u1FDB\u038A\u1FE3\u03B0"
  u"\u1FEB\u038E\u1FEE\u0385\u1FEF`\u1FF9\u038C\u1FFB\u038F\u1FFD\u00B4\u2000\u2002\u2001\u2003\u2126\u03A9\u212AK"
  u"\u212B\u00C5\u2329\u3008\u232A\u3009"},
{0x300, u"ÀAÈEÌIÒOÙUàaèeìiòoùuǛÜǜüǸNǹnЀЕЍИѐеѝиḔĒḕēṐŌṑōẀWẁwẦÂầâẰĂằăỀÊềêỒÔồôỜƠờơỪƯừưỲYỳyἂἀἃἁἊἈἋἉἒἐἓἑἚἘἛἙἢἠἣἡἪἨἫἩἲἰἳἱἺἸἻἹὂὀὃὁὊὈ"
  u"ὋὉὒὐὓὑὛὙὢὠὣὡὪὨὫὩὰαὲεὴηὶιὸοὺυὼωᾺΑῈΕῊΗ῍᾿ῒϊῚΙ῝῾ῢϋῪΥ῭¨ῸΟῺΩ"},
{0x301, u"ÁAÉEÍIÓOÚUÝYáaéeíióoúuýyĆCćcĹLĺlŃNńnŔRŕrŚSśsŹZźzǗÜǘüǴGǵgǺÅǻåǼÆǽæǾØǿø\u0344\u0308΅¨ΆΑΈΕΉΗΊΙΌΟΎΥΏΩΐϊάαέεήηίιΰϋόούυώω"
  u"ϓϒЃГЌКѓгќкḈÇḉçḖĒḗēḮÏḯïḰKḱkḾMḿmṌÕṍõṒŌṓōṔPṕpṸŨṹũẂWẃwẤÂấâẮĂắăẾÊếêỐÔốôỚƠớơỨƯứưἄἀἅἁἌἈἍἉἔἐἕἑἜἘἝἙἤἠἥἡἬἨἭἩἴἰἵἱἼἸἽἹὄὀὅὁὌὈὍὉὔὐὕὑὝὙ"
  u"ὤὠὥὡὬὨὭὩ῎᾿῞῾"}, {0x302, u"ÂAÊEÎIÔOÛUâaêeîiôoûuĈCĉcĜGĝgĤHĥhĴJĵjŜSŝsŴWŵwŶYŷyẐZẑzẬẠậạỆẸệẹỘỌộọ"},
{0x303, u"ÃAÑNÕOãañnõoĨIĩiŨUũuṼVṽvẪÂẫâẴĂẵăẼEẽeỄÊễêỖÔỗôỠƠỡơỮƯữưỸYỹy"},
{0x304, u"ĀAāaĒEēeĪIīiŌOōoŪUūuǕÜǖüǞÄǟäǠȦǡȧǢÆǣæǬǪǭǫȪÖȫöȬÕȭõȰȮȱȯȲYȳyӢИӣиӮУӯуḠGḡgḸḶḹḷṜṚṝṛᾱαᾹΑῑιῙΙῡυῩΥ"},
{0x306, u"ĂAăaĔEĕeĞGğgĬIĭiŎOŏoŬUŭuЎУЙИйиўуӁЖӂжӐАӑаӖЕӗеḜȨḝȩẶẠặạᾰαᾸΑῐιῘΙῠυῨΥ"},
{0x307, u"ĊCċcĖEėeĠGġgİIŻZżzȦAȧaȮOȯoḂBḃbḊDḋdḞFḟfḢHḣhṀMṁmṄNṅnṖPṗpṘRṙrṠSṡsṤŚṥśṦŠṧšṨṢṩṣṪTṫtẆWẇwẊXẋxẎYẏyẛſ"},
{0x308, u"ÄAËEÏIÖOÜUäaëeïiöoüuÿyŸYΪΙΫΥϊιϋυϔϒЁЕЇІёеїіӒАӓаӚӘӛәӜЖӝжӞЗӟзӤИӥиӦОӧоӪӨӫөӬЭӭэӰУӱуӴЧӵчӸЫӹыḦHḧhṎÕṏõṺŪṻūẄWẅwẌXẍxẗt"},
{0x309, u"ẢAảaẨÂẩâẲĂẳăẺEẻeỂÊểêỈIỉiỎOỏoỔÔổôỞƠởơỦUủuỬƯửưỶYỷy"}, {0x30a, u"ÅAåaŮUůuẘwẙy"}, {0x30b, u"ŐOőoŰUűuӲУӳу"},
{0x30c, u"ČCčcĎDďdĚEěeĽLľlŇNňnŘRřrŠSšsŤTťtŽZžzǍAǎaǏIǐiǑOǒoǓUǔuǙÜǚüǦGǧgǨKǩkǮƷǯʒǰjȞHȟh"},
{0x30f, u"ȀAȁaȄEȅeȈIȉiȌOȍoȐRȑrȔUȕuѶѴѷѵ"}, {0x311, u"ȂAȃaȆEȇeȊIȋiȎOȏoȒRȓrȖUȗu"}, {0x313, u"ἀαἈΑἐεἘΕἠηἨΗἰιἸΙὀοὈΟὐυὠωὨΩῤρ"},
{0x314, u"ἁαἉΑἑεἙΕἡηἩΗἱιἹΙὁοὉΟὑυὙΥὡωὩΩῥρῬΡ"}, {0x31b, u"ƠOơoƯUưu"},
{0x323, u"ḄBḅbḌDḍdḤHḥhḲKḳkḶLḷlṂMṃmṆNṇnṚRṛrṢSṣsṬTṭtṾVṿvẈWẉwẒZẓzẠAạaẸEẹeỊIịiỌOọoỢƠợơỤUụuỰƯựưỴYỵy"}, {0x324, u"ṲUṳu"},
{0x325, u"ḀAḁa"}, {0x326, u"ȘSșsȚTțt"}, {0x327, u"ÇCçcĢGģgĶKķkĻLļlŅNņnŖRŗrŞSşsŢTţtȨEȩeḐDḑdḨHḩh"},
{0x328, u"ĄAąaĘEęeĮIįiŲUųuǪOǫo"}, {0x32d, u"ḒDḓdḘEḙeḼLḽlṊNṋnṰTṱtṶUṷu"}, {0x32e, u"ḪHḫh"}, {0x330, u"ḚEḛeḬIḭiṴUṵu"},
{0x331, u"ḆBḇbḎDḏdḴKḵkḺLḻlṈNṉnṞRṟrṮTṯtẔZẕzẖh"},
{0x338, u"↚←↛→↮↔⇍⇐⇎⇔⇏⇒∄∃∉∈∌∋∤∣∦∥≁∼≄≃≇≅≉≈≠=≢≡≭≍≮<≯>≰≤≱≥≴≲≵≳≸≶≹≷⊀≺⊁≻⊄⊂⊅⊃⊈⊆⊉⊇⊬⊢⊭⊨⊮⊩⊯⊫⋠≼⋡≽⋢⊑⋣⊒⋪⊲⋫⊳⋬⊴⋭⊵\u2ADC\u2ADD"},
{0x342, u"ἆἀἇἁἎἈἏἉἦἠἧἡἮἨἯἩἶἰἷἱἾἸἿἹὖὐὗὑὟὙὦὠὧὡὮὨὯὩᾶα῁¨ῆη῏᾿ῖιῗϊ῟῾ῦυῧϋῶω"},
{0x345, u"ᾀἀᾁἁᾂἂᾃἃᾄἄᾅἅᾆἆᾇἇᾈἈᾉἉᾊἊᾋἋᾌἌᾍἍᾎἎᾏἏᾐἠᾑἡᾒἢᾓἣᾔἤᾕἥᾖἦᾗἧᾘἨᾙἩᾚἪᾛἫᾜἬᾝἭᾞἮᾟἯᾠὠᾡὡᾢὢᾣὣᾤὤᾥὥᾦὦᾧὧᾨὨᾩὩᾪὪᾫὫᾬὬᾭὭᾮὮᾯὯᾲὰᾳαᾴάᾷᾶᾼΑῂὴῃηῄήῇῆ"
  u"ῌΗῲὼῳωῴώῷῶῼΩ"}, {0x5b4, u"\uFB1D\u05D9"}, {0x5b7, u"\uFB1F\u05F2\uFB2E\u05D0"}, {0x5b8, u"\uFB2F\u05D0"},
{0x5b9, u"\uFB4B\u05D5"},
{0x5bc, u"\uFB30\u05D0\uFB31\u05D1\uFB32\u05D2\uFB33\u05D3\uFB34\u05D4\uFB35\u05D5\uFB36\u05D6\uFB38\u05D8\uFB39\u05D9"
  u"\uFB3A\u05DA\uFB3B\u05DB\uFB3C\u05DC\uFB3E\u05DE\uFB40\u05E0\uFB41\u05E1\uFB43\u05E3\uFB44\u05E4\uFB46\u05E6\uFB47\u05E7"
  u"\uFB48\u05E8\uFB49\u05E9\uFB4A\u05EA"}, {0x5bf, u"\uFB4C\u05D1\uFB4D\u05DB\uFB4E\u05E4"},
{0x5c1, u"\uFB2A\u05E9\uFB2C\uFB49"}, {0x5c2, u"\uFB2B\u05E9\uFB2D\uFB49"}, {0x653, u"\u0622\u0627"},
{0x654, u"\u0623\u0627\u0624\u0648\u0626\u064A\u06C0\u06D5\u06C2\u06C1\u06D3\u06D2"}, {0x655, u"\u0625\u0627"},
{0x93c, u"\u0929\u0928\u0931\u0930\u0934\u0933\u0958\u0915\u0959\u0916\u095A\u0917\u095B\u091C\u095C\u0921\u095D\u0922"
  u"\u095E\u092B\u095F\u092F"}, {0x9bc, u"\u09DC\u09A1\u09DD\u09A2\u09DF\u09AF"}, {0x9be, u"\u09CB\u09C7"},
{0x9d7, u"\u09CC\u09C7"}, {0xa3c, u"\u0A33\u0A32\u0A36\u0A38\u0A59\u0A16\u0A5A\u0A17\u0A5B\u0A1C\u0A5E\u0A2B"},
{0xb3c, u"\u0B5C\u0B21\u0B5D\u0B22"}, {0xb3e, u"\u0B4B\u0B47"}, {0xb56, u"\u0B48\u0B47"}, {0xb57, u"\u0B4C\u0B47"},
{0xbbe, u"\u0BCA\u0BC6\u0BCB\u0BC7"}, {0xbd7, u"\u0B94\u0B92\u0BCC\u0BC6"}, {0xc56, u"\u0C48\u0C46"}, {0xcc2, u"\u0CCA\u0CC6"},
{0xcd5, u"\u0CC0\u0CBF\u0CC7\u0CC6\u0CCB\u0CCA"}, {0xcd6, u"\u0CC8\u0CC6"}, {0xd3e, u"\u0D4A\u0D46\u0D4B\u0D47"},
{0xd57, u"\u0D4C\u0D46"}, {0xdca, u"\u0DDA\u0DD9\u0DDD\u0DDC"}, {0xdcf, u"\u0DDC\u0DD9"}, {0xddf, u"\u0DDE\u0DD9"},
{0xf72, u"\u0F73\u0F71"}, {0xf74, u"\u0F75\u0F71"}, {0xf80, u"\u0F76\u0FB2\u0F78\u0FB3\u0F81\u0F71"},
{0xfb5, u"\u0F69\u0F40\u0FB9\u0F90"},
{0xfb7, u"\u0F43\u0F42\u0F4D\u0F4C\u0F52\u0F51\u0F57\u0F56\u0F5C\u0F5B\u0F93\u0F92\u0F9D\u0F9C\u0FA2\u0FA1\u0FA7\u0FA6"
  u"\u0FAC\u0FAB"}, {0x102e, u"\u1026\u1025"},
{0x1b35, u"\u1B06\u1B05\u1B08\u1B07\u1B0A\u1B09\u1B0C\u1B0B\u1B0E\u1B0D\u1B12\u1B11\u1B3B\u1B3A\u1B3D\u1B3C\u1B40\u1B3E"
  u"\u1B41\u1B3F\u1B43\u1B42"},
{0x3099, u"がかぎきぐくげけごこざさじしずすぜせぞそだたぢちづつでてどとばはびひぶふべへぼほゔうゞゝガカギキグクゲケゴコザサジシズスゼセゾソダタヂチヅツデテドトバハビヒブフベヘボホヴウヷワヸヰヹヱヺヲヾヽ"},
{0x309a, u"ぱはぴひぷふぺへぽほパハピヒプフペヘポホ"},
	// clang-format on
